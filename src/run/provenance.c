#include "run/provenance.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/build.h"
#include "base/hash.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/path.h"
#include "base/version.h"
#include "output/product.h"
#include "output/sealed.h"
#include "system/atomic_file.h"
#include "text/json.h"

enum { RUN_JSON_MAX = 16 << 20 };

static bool same_build(const struct maker *a, const struct maker *b)
{
    return *a->build && strcmp(a->build, b->build) == 0;
}

static bool same_device(const struct maker *a, const struct maker *b)
{
    return strcmp(a->device, b->device) == 0 && strcmp(a->driver, b->driver) == 0;
}

/* ---- reading run.json */

static bool copy(const struct json *object, const char *key, char *out, size_t size)
{
    const char *text = json_to_text(json_member(object, key));
    if (!text || strlen(text) >= size)
        return false;
    memcpy(out, text, strlen(text) + 1);
    return true;
}

/* False if the object does not name a maker. Version 0.1.0 wrote no build. */
static bool read_maker(const struct json *object, struct maker *out)
{
    *out = (struct maker){0};
    if (json_member(object, "build") && !copy(object, "build", out->build, sizeof out->build))
        return false;
    return copy(object, "version", out->version, sizeof out->version) &&
           copy(object, "commit", out->commit, sizeof out->commit) &&
           copy(object, "device", out->device, sizeof out->device) &&
           copy(object, "driver", out->driver, sizeof out->driver);
}

static status add(struct provenance *p, int frame, const struct maker *maker)
{
    status st = OK;
    TRY(memory_grow(&p->continued, &p->capacity, p->n + 1, sizeof *p->continued, "the makers of a run"));
    p->continued[p->n++] = (struct continued){frame, *maker};
done:
    return st;
}

static status add_change(struct provenance *p, const struct change *change)
{
    status st = OK;
    TRY(memory_grow(&p->change, &p->change_capacity, p->n_changes + 1, sizeof *p->change,
                    "the changes of a run"));
    p->change[p->n_changes++] = *change;
done:
    return st;
}

static status read_run(const char *root, struct provenance *p)
{
    status st = OK;
    struct path path;
    char *bytes = NULL;
    size_t size;
    struct json *json = NULL;
    struct maker maker;
    int frame;
    TRY(path_join(&path, root, "run.json"));
    TRY(file_read(path.text, RUN_JSON_MAX, &bytes, &size));
    TRY(json_read(path.text, bytes, size, &json));
    p->known = read_maker(json, &p->maker);
    const struct json *list = json_member(json, "continued");
    for (const struct json *v = list && list->kind == JSON_ARRAY ? list->first : NULL; v; v = v->next)
        if (read_maker(v, &maker) && json_to_int(json_member(v, "frame"), &frame))
            TRY(add(p, frame, &maker));
    const struct json *from = json_member(json, "from"),
                      *spacing = from ? json_member(from, "spacing_m") : NULL;
    if (spacing && spacing->kind == JSON_NUMBER && isfinite(spacing->number))
        p->from_m = spacing->number;
    list = json_member(json, "changed");
    for (const struct json *v = list && list->kind == JSON_ARRAY ? list->first : NULL; v; v = v->next) {
        struct change change = {.any = true};
        if (json_to_int(json_member(v, "frame"), &change.frame) &&
            sealed_to_hash(json_member(v, "job_hash"), &change.job_hash))
            TRY(add_change(p, &change));
    }
done:
    json_free(&json);
    free(bytes);
    return st == E_INPUT ? OK : st; /* there is no run.json before a folder's first run */
}

status provenance_begin(const struct gpu *gpu, const char *root, enum run_resume resume,
                        struct provenance *out)
{
    const struct gpu_info *info = gpu_info(gpu);
    *out = (struct provenance){.allowed = resume};
    struct maker *here = &out->here;
    snprintf(here->version, sizeof here->version, "%s", hoodoo_version);
    snprintf(here->commit, sizeof here->commit, "%s", hoodoo_commit);
    snprintf(here->build, sizeof here->build, "%s", hoodoo_build);
    snprintf(here->device, sizeof here->device, "%s", info->name);
    snprintf(here->driver, sizeof here->driver, "%s", info->driver);
    return resume == RUN_NEVER ? OK : read_run(root, out);
}

void provenance_free(struct provenance *p)
{
    free(p->continued);
    free(p->change);
    *p = (struct provenance){0};
}

/* ---- may this process continue? */

static bool same(const struct maker *a, const struct maker *b)
{
    return same_build(a, b) && same_device(a, b);
}

static status refuse(const struct maker *maker, const struct maker *here, const char *what)
{
    const char *word = same_device(maker, here)  ? "other-build"
                       : same_build(maker, here) ? "other-device"
                                                 : "other-device-and-build";
    if (same_build(maker, here))
        return fail(
            E_CHECKPOINT,
            "%s was made on %s (%s), and this device is %s (%s); add --resume %s to continue anyway, though not bit for bit",
            what, maker->device, maker->driver, here->device, here->driver, word);
    return fail(
        E_CHECKPOINT,
        "%s was made by hoodoo %s (%s, build %s), and this is hoodoo %s (%s, build %s), whose results may differ; continue with the former, or add --resume %s to continue anyway, though not bit for bit",
        what, maker->version, maker->commit, *maker->build ? maker->build : "unknown", here->version,
        here->commit, here->build, word);
}

/* Appends to the list unless it has that entry: a run that was stopped before its first checkpoint continues the same state again. */
static status add_once(struct provenance *p, const struct maker *maker, int frame)
{
    for (size_t i = 0; i < p->n; i++)
        if (p->continued[i].frame == frame && same(&p->continued[i].maker, maker))
            return OK;
    return add(p, frame, maker);
}

/* E_CHECKPOINT unless this process may continue what `maker` made. */
static status check(const struct provenance *p, const struct maker *maker, const char *what)
{
    const struct maker *here = &p->here;
    bool build = p->allowed == RUN_OTHER_BUILD || p->allowed == RUN_OTHER_BOTH;
    bool device = p->allowed == RUN_OTHER_DEVICE || p->allowed == RUN_OTHER_BOTH;
    if ((!same_build(maker, here) && !build) || (!same_device(maker, here) && !device))
        return refuse(maker, here, what);
    if (!same(maker, here))
        log_warn(
            "%s was made by hoodoo %s (%s, build %s) on %s, %s; continuing with %s (%s, build %s) on %s, %s: not bit for bit",
            what, maker->version, maker->commit, *maker->build ? maker->build : "unknown", maker->device,
            maker->driver, here->version, here->commit, here->build, here->device, here->driver);
    return OK;
}

status provenance_continue(struct provenance *p, const struct maker *maker, int frame, const char *what)
{
    status st = OK;
    TRY(check(p, maker, what));
    if (!same(maker, &p->here))
        TRY(add_once(p, maker, frame));
done:
    return st;
}

status provenance_restart(struct provenance *p, int first, const char *root)
{
    status st = OK;
    if (!p->known)
        return OK;
    for (size_t i = 0; i < p->n; i++)
        TRY(check(p, &p->continued[i].maker, root));
    TRY(provenance_continue(p, &p->maker, first, root));
done:
    return st;
}

/* ---- writing job.yaml and run.json */

static void add_maker(struct text *t, const struct maker *maker)
{
    json_text(t, "version", maker->version);
    json_text(t, "commit", maker->commit);
    json_text(t, "build", maker->build);
    json_text(t, "device", maker->device);
    json_text(t, "driver", maker->driver);
}

static void add_continued(struct text *t, const struct provenance *p)
{
    if (p->n == 0)
        return;
    json_array(t, "continued");
    for (size_t i = 0; i < p->n; i++) {
        json_object(t, NULL);
        json_integer(t, "frame", p->continued[i].frame);
        add_maker(t, &p->continued[i].maker);
        json_end_object(t);
    }
    json_end_array(t);
}

static void add_changes(struct text *t, const struct provenance *p)
{
    char hash[17];
    if (p->n_changes == 0)
        return;
    json_array(t, "changed");
    for (size_t i = 0; i < p->n_changes; i++) {
        json_object(t, NULL);
        json_integer(t, "frame", p->change[i].frame);
        json_text(t, "job_hash", hash_text(p->change[i].job_hash, hash));
        json_end_object(t);
    }
    json_end_array(t);
}

static void add_job(const struct provenance *p, struct text *t, const struct job *job, uint64_t job_hash)
{
    char hash[17];
    json_integer(t, "seed", job->seed);
    json_text(t, "job_hash", hash_text(job_hash, hash));
    if (*job->from) {
        json_object(t, "from");
        json_text(t, "checkpoint", job->from);
        json_integer(t, "frame", job->frames.first);
        if (p->from_m > 0)
            json_number(t, "spacing_m", p->from_m);
        json_end_object(t);
    }
    if (job->wedge.index) {
        json_integer(t, "wedge", job->wedge.index);
        json_text(t, "wedge_values", job->wedge.label);
    }
}

static status add_inputs(struct text *t, const struct job *job)
{
    status st = OK;
    struct job_input *input = NULL;
    size_t n = 0;
    char hash[17];
    TRY(job_inputs(job, &input, &n));
    json_array(t, "inputs");
    for (size_t i = 0; i < n; i++) {
        json_object(t, NULL);
        json_text(t, "path", input[i].path);
        json_integer(t, "size", (int64_t)input[i].size);
        json_text(t, "xxh3", hash_text(input[i].hash, hash));
        json_end_object(t);
    }
    json_end_array(t);
done:
    job_inputs_free(&input, n);
    return st;
}

static status write_product(const char *root, const char *path, const struct text *t)
{
    static const char *const command[] = {"run"};
    const struct recipe recipe = {.root = root, .word = command, .n_words = 1, .frame = ALL_FRAMES};
    return product_write(&recipe, path, t->data, t->size);
}

static status write_job(const struct job *job, const char *root)
{
    status st = OK;
    struct text t = {0};
    TRY(job_resolved(job, &t));
    TRY(write_product(root, "job.yaml", &t));
done:
    text_free(&t);
    return st;
}

static status write_run(const struct provenance *p, const struct gpu *gpu, const struct job *job,
                        uint64_t job_hash, const char *root)
{
    status st = OK;
    struct text t = {0};
    json_object(&t, NULL);
    json_integer(&t, "format", 1);
    json_text(&t, "name", job->name);
    if (*p->here.version)
        add_maker(&t, &p->here);
    if (gpu) {
        json_text(&t, "device_uuid", gpu_info(gpu)->uuid);
        json_text(&t, "device_pci", gpu_info(gpu)->pci);
    }
    add_continued(&t, p);
    add_changes(&t, p);
    add_job(p, &t, job, job_hash);
    TRY(add_inputs(&t, job));
    json_end_object(&t);
    TRY(text_status(&t));
    TRY(write_product(root, "run.json", &t));
done:
    text_free(&t);
    return st;
}

/* job.yaml comes last: it decides whose folder this is. */
status provenance_write(const struct provenance *p, const struct gpu *gpu, const struct job *job,
                        uint64_t job_hash, const char *root)
{
    const status st = write_run(p, gpu, job, job_hash, root);
    return st == OK ? write_job(job, root) : st;
}

status provenance_change(struct provenance *p, const struct change *change)
{
    return change->any ? add_change(p, change) : OK;
}

/* The maker of the newest sound checkpoint; without one, *out is not changed. */
static status maker_of_newest(const char *root, const char *name, struct maker *out)
{
    status st = OK;
    int *frames = NULL;
    size_t n;
    struct path path;
    struct checkpoint c;
    TRY(checkpoint_list(root, name, &frames, &n));
    for (size_t i = 0; i < n; i++) {
        TRY(folder_path(&path, root, name, FILE_CHECKPOINT, frames[i], NULL));
        st = checkpoint_read_index(path.text, &c);
        if (st == OK) {
            *out = c.maker;
            break;
        }
        if (st == E_MEMORY)
            goto done;
        st = OK;
    }
done:
    free(frames);
    return st;
}

/* *recorded: the file has a sound record. *intact: it also matches that record. */
static status check_file(const char *root, const char *path, bool *recorded, bool *intact)
{
    struct product p = {0};
    status st = product_read(root, path, &p);
    *recorded = st == OK;
    if (st == OK)
        st = listed_check(root, &p.file, true);
    *intact = st == OK;
    product_free(&p);
    return st == E_INPUT ? OK : st;
}

status provenance_intact(const char *root, bool *intact)
{
    bool recorded;
    const status st = check_file(root, "job.yaml", &recorded, intact);
    return st == OK && *intact ? check_file(root, "run.json", &recorded, intact) : st;
}

/* Writes the existing file again, to give it a record. */
static status record_again(const char *root, const char *path)
{
    status st = OK;
    struct path full;
    struct text t = {0};
    TRY(path_join(&full, root, path));
    TRY(file_read(full.text, RUN_JSON_MAX, &t.data, &t.size));
    TRY(write_product(root, path, &t));
done:
    text_free(&t);
    return st;
}

status provenance_restore(const struct job *job, uint64_t job_hash, const struct change *change,
                          const char *root)
{
    status st = OK;
    struct provenance p = {0};
    uint64_t hash;
    bool recorded, intact;
    TRY(check_file(root, "run.json", &recorded, &intact));
    if ((intact || !recorded) && !change->any && folder_job_hash(root, &hash) == OK && hash == job_hash) {
        if (!intact)
            TRY(record_again(root, "run.json"));
        TRY(write_job(job, root));
        goto done;
    }
    if (!change->any)
        log_warn("%s/run.json is missing, damaged or belongs to another job; it is rewritten", root);
    if (!recorded || intact)
        TRY(read_run(root, &p));
    if (p.known)
        p.here = p.maker;
    else
        TRY(maker_of_newest(root, job->name, &p.here));
    TRY(provenance_change(&p, change));
    TRY(write_run(&p, NULL, job, job_hash, root));
    TRY(write_job(job, root));
done:
    provenance_free(&p);
    return st;
}
