#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/hash.h"
#include "base/memory.h"
#include "output/folder.h"
#include "output/sealed.h"
#include "text/json.h"

enum { MOST_FILES = 4096 };

status manifest_write(const char *root, const char *name, const struct manifest *m)
{
    status st = OK;
    struct path path;
    struct text t = {0};
    TRY(folder_path(&path, root, name, FILE_MANIFEST, m->frame, NULL));
    json_object(&t, NULL);
    json_text(&t, "kind", "hoodoo frame");
    json_integer(&t, "format", 1);
    json_integer(&t, "frame", m->frame);
    sealed_add_hash(&t, "job_xxh3", m->job_hash);
    sealed_add_hash(&t, "output_xxh3", m->files_hash);
    json_number(&t, "years", m->years);
    json_array(&t, "files");
    for (size_t i = 0; i < m->n_files; i++) {
        json_object(&t, NULL);
        json_text(&t, "path", m->file[i].path);
        json_integer(&t, "size", (int64_t)m->file[i].size);
        sealed_add_hash(&t, "xxh3", m->file[i].hash);
        json_end_object(&t);
    }
    json_end_array(&t);
    json_object(&t, "statistics");
    json_number(&t, "volume_m3", m->volume_m3);
    json_number(&t, "start_volume_m3", m->start_volume_m3);
    json_number(&t, "max_stress_Pa", m->max_stress_Pa);
    json_integer(&t, "stress_iterations", m->stress_iterations);
    json_end_object(&t);
    json_object(&t, "ledger");
#define LEDGER(X) X(start) X(rock) X(deposit) X(fallen) X(left)
#define WRITE(what) json_integer(&t, #what, (int64_t)m->ledger.what);
    LEDGER(WRITE)
#undef WRITE
    json_end_object(&t);
    if (m->n_changes) {
        json_object(&t, "change_m3");
        for (size_t i = 0; i < m->n_changes; i++)
            json_number(&t, m->change[i].process, m->change[i].m3);
        json_end_object(&t);
    }
    TRY(sealed_write(path.text, &t));
done:
    text_free(&t);
    return st;
}

/* A number that is not finite is written as null. */
static bool to_number(const struct json *json, double *out)
{
    if (!json || (json->kind != JSON_NUMBER && json->kind != JSON_NULL))
        return false;
    *out = json->kind == JSON_NUMBER ? json->number : (double)NAN;
    return true;
}

static bool to_files(const struct json *files, struct manifest *out)
{
    if (!files || files->kind != JSON_ARRAY)
        return false;
    for (const struct json *item = files->first; item; item = item->next) {
        struct manifest_file *f = &out->file[out->n_files];
        const char *path = json_to_text(json_member(item, "path"));
        if (!path || strlen(path) >= sizeof f->path || !sealed_is_inside(path) ||
            !json_to_uint64(json_member(item, "size"), &f->size) ||
            !sealed_to_hash(json_member(item, "xxh3"), &f->hash))
            return false;
        snprintf(f->path, sizeof f->path, "%s", path);
        out->n_files++;
    }
    return true;
}

/* Models without processes have no changes. */
static bool to_changes(const struct json *changes, struct manifest *out)
{
    if (!changes)
        return true;
    if (changes->kind != JSON_OBJECT || changes->n > PROCESSES)
        return false;
    for (const struct json *item = changes->first; item; item = item->next) {
        struct manifest_change *c = &out->change[out->n_changes++];
        if (strlen(item->key) >= sizeof c->process || !to_number(item, &c->m3))
            return false;
        snprintf(c->process, sizeof c->process, "%s", item->key);
    }
    return true;
}

/* Returns "", or what is wrong. out->file must hold all files. */
static const char *to_manifest(const struct json *json, struct manifest *out)
{
    const char *kind = json_to_text(json_member(json, "kind"));
    const struct json *statistics = json_member(json, "statistics"), *ledger = json_member(json, "ledger");
    uint64_t format;
    if (!kind || strcmp(kind, "hoodoo frame") != 0 || !json_to_uint64(json_member(json, "format"), &format))
        return "it is not the manifest of a frame";
    if (format != 1)
        return "it has a later format; use a newer version of hoodoo";
    if (!json_to_int(json_member(json, "frame"), &out->frame) ||
        !sealed_to_hash(json_member(json, "job_xxh3"), &out->job_hash) ||
        !sealed_to_hash(json_member(json, "output_xxh3"), &out->files_hash) ||
        !to_number(json_member(json, "years"), &out->years))
        return "its frame, job_xxh3, output_xxh3 or years is missing or wrong";
    if (!to_files(json_member(json, "files"), out))
        return "a file in it lacks a path inside the folder, a size or a hash";
    if (!to_number(json_member(statistics, "volume_m3"), &out->volume_m3) ||
        !to_number(json_member(statistics, "start_volume_m3"), &out->start_volume_m3) ||
        !to_number(json_member(statistics, "max_stress_Pa"), &out->max_stress_Pa) ||
        !json_to_int(json_member(statistics, "stress_iterations"), &out->stress_iterations))
        return "a number of its statistics is missing or wrong";
#define READ(what)                                                                                           \
    if (!json_to_uint64(json_member(ledger, #what), &out->ledger.what))                                      \
        return "a number of its ledger is missing or wrong";
    LEDGER(READ)
#undef READ
    if (!to_changes(json_member(json, "change_m3"), out))
        return "its change_m3 is wrong";
    return "";
}

status manifest_read(const char *root, const char *name, int frame, struct manifest *out)
{
    status st = OK;
    struct path path;
    struct json *json = NULL;
    struct manifest m = {0};
    const struct json *files;
    const char *wrong;
    TRY(folder_path(&path, root, name, FILE_MANIFEST, frame, NULL));
    TRY(sealed_read(path.text, "a frame's manifest", &json));
    files = json_member(json, "files");
    if (files && files->n > MOST_FILES) {
        st = fail(E_INPUT, "%s: it lists %zu files, more than the %d allowed", path.text, files->n,
                  MOST_FILES);
        goto done;
    }
    TRY(memory_alloc(files ? files->n : 0, sizeof *m.file, path.text, &m.file));
    wrong = to_manifest(json, &m);
    if (!*wrong && m.frame != frame)
        wrong = "it belongs to another frame than its name says";
    if (*wrong) {
        st = fail(E_INPUT, "%s: %s", path.text, wrong);
        goto done;
    }
    *out = m;
    m = (struct manifest){0};
done:
    manifest_free(&m);
    if (json)
        json_free(&json);
    return st;
}

bool manifest_lists(const struct manifest *m, const char *folder, const char *extension)
{
    for (size_t i = 0; i < m->n_files; i++) {
        const char *path = m->file[i].path, *dot = strrchr(path, '.');
        if (strncmp(path, folder, strlen(folder)) == 0 && dot && strcmp(dot, extension) == 0)
            return true;
    }
    return false;
}

void manifest_free(struct manifest *manifest)
{
    free(manifest->file);
    *manifest = (struct manifest){0};
}

status listed_check(const char *root, const struct manifest_file *f, bool deep)
{
    struct path path;
    struct stat info;
    uint64_t hash = 0, size = 0;
    status st = OK;
    TRY(path_join(&path, root, f->path));
    if (stat(path.text, &info) != 0)
        st = fail(E_INPUT, "%s: %s", path.text, strerror(errno));
    else if (!S_ISREG(info.st_mode))
        st = fail(E_INPUT, "%s: not a regular file", path.text);
    else if ((uint64_t)info.st_size != f->size)
        st = fail(E_INPUT, "%s: %lld bytes, but %llu were written", path.text, (long long)info.st_size,
                  (unsigned long long)f->size);
    else if (deep && (st = hash_file(path.text, &hash, &size)) == OK && (hash != f->hash || size != f->size))
        st = fail(E_INPUT, "%s: damaged: its content is not what was written", path.text);
done:
    return st;
}

status manifest_check(const char *root, const struct manifest *manifest, bool deep, const char **bad)
{
    *bad = "";
    for (size_t i = 0; i < manifest->n_files && !**bad; i++) {
        status st = listed_check(root, &manifest->file[i], deep);
        if (st == E_MEMORY)
            return st;
        if (st != OK)
            *bad = manifest->file[i].path;
    }
    return OK;
}

status manifest_source(const char *root, const char *name, int frame, uint64_t *hash)
{
    static const char *const sources[] = {"points/", "volumes/", "rocks/"};
    status st = OK;
    struct manifest m = {0};
    uint64_t seen[2] = {0};
    TRY(manifest_read(root, name, frame, &m));
    for (size_t i = 0; i < m.n_files; i++)
        for (size_t k = 0; k < sizeof sources / sizeof *sources; k++)
            if (strncmp(m.file[i].path, sources[k], strlen(sources[k])) == 0) {
                seen[1] = m.file[i].hash;
                seen[0] = hash_bytes(seen, sizeof seen);
            }
    *hash = seen[0];
done:
    manifest_free(&m);
    return st;
}
