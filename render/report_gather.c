#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/log.h"
#include "base/memory.h"
#include "checkpoint/checkpoint.h"
#include "render/report.h"
#include "run/owner.h"
#include "system/atomic_file.h"
#include "vdb/vdb.h"

enum { LARGEST_LOG = 64 << 20, LOG_LINES = 24, MAX_SESSIONS = 10000 };

void report_note(struct report *r, const char *format, ...)
{
    char line[2200];
    va_list args;
    va_start(args, format);
    vsnprintf(line, sizeof line, format, args);
    va_end(args);
    for (char *c = line; *c; c++)
        if (*c == '\n')
            *c = ' ';
    text_add(&r->notes, "%s\n", line);
}

/* ---- frames */

/* Is the path safe to pass to other programs, that is, without characters that are special to them? */
static bool is_plain(const char *path)
{
    return *path != '-' &&
           strspn(path, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./") == strlen(path);
}

static bool there(const struct report *r, const char *path)
{
    struct path full;
    return path_join(&full, r->root, path) == OK && access(full.text, R_OK) == 0;
}

static void find_still(const struct report *r, struct report_frame *f)
{
    if (folder_name(&f->source, r->name, FILE_STILL, f->manifest.frame, NULL) != OK ||
        !there(r, f->source.text))
        f->source.text[0] = '\0';
}

static void find_field_picture(const struct report *r, struct report_frame *f)
{
    f->source.text[0] = '\0';
    for (size_t i = 0; i < f->manifest.n_files && !*f->source.text; i++) {
        const char *path = f->manifest.file[i].path;
        if (strncmp(path, "aov/", 4) == 0 && is_plain(path) && there(r, path) &&
            path_format(&f->source, "%s", path) != OK)
            return;
    }
}

/* Stills if at least two frames have them, otherwise the pictures of the run: all of one kind, so that they can be compared. */
static void find_sources(struct report *r)
{
    size_t n_stills = 0, n_others = 0;
    for (size_t i = 0; i < r->n_frames; i++)
        if (!r->frame[i].damaged) {
            find_still(r, &r->frame[i]);
            n_stills += *r->frame[i].source.text != '\0';
            n_others += manifest_lists(&r->frame[i].manifest, "aov/", ".exr");
        }
    r->stills = n_stills >= 2 || (n_stills == 1 && n_others < 2);
    for (size_t i = 0; !r->stills && i < r->n_frames; i++)
        if (!r->frame[i].damaged)
            find_field_picture(r, &r->frame[i]);
}

static status add_frame(struct report *r, const struct job_states *states, int frame)
{
    const char *bad = "";
    struct report_frame *f = &r->frame[r->n_frames++];
    status st = manifest_read(r->root, r->name, frame, &f->manifest);
    if (st == OK)
        st = manifest_check(r->root, &f->manifest, false, &bad);
    if (st == E_MEMORY)
        return st;
    if (st == OK && !*bad && states->n && !job_states_hold(states, frame, f->manifest.job_hash))
        st = fail(E_INPUT, "it belongs to another job");
    f->damaged = st != OK || *bad;
    if (f->damaged)
        snprintf(f->what, sizeof f->what, "%.500s", status_message());
    f->manifest.frame = frame; /* set even if the manifest cannot be read */
    r->n_damaged += f->damaged;
    r->n_sound += !f->damaged;
    for (size_t i = 0; i < f->manifest.n_files; i++)
        r->disk += f->manifest.file[i].size;
    f->has_volumes = manifest_lists(&f->manifest, "volumes/", ".vdb");
    return OK;
}

static status find_frames(struct report *r)
{
    status st = OK;
    int *frames = NULL;
    size_t n;
    struct job_states states = {0};
    bool edited;
    char why[600];
    st = owner_states(r->root, &states, &edited, why);
    if (st == E_INPUT) {
        snprintf(why, sizeof why, "%.590s", status_message());
        st = OK;
    }
    TRY(st);
    if (*why)
        report_note(r, "%s.", why);
    TRY(folder_frames(r->root, r->name, &frames, &n));
    TRY(memory_alloc(n, sizeof *r->frame, "the frames", &r->frame));
    for (size_t i = 0; i < n; i++)
        if (range_holds(r->frames, frames[i]))
            TRY(add_frame(r, &states, frames[i]));
    r->n_missing = range_count(r->frames) - r->n_frames;
    find_sources(r);
done:
    job_states_free(&states);
    free(frames);
    return st;
}

/* ---- stress and layers */

static int ascending(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* `value`: Pa, sorted in place. The range of the bins includes 0 and all values except the outermost half percent at each end. */
static void fill_bins(struct report_stress *s, float *value, size_t n)
{
    if (n == 0)
        return;
    qsort(value, n, sizeof *value, ascending);
    s->low = fmin((double)value[n / 200] / 1e6, 0);
    s->high = fmax((double)value[n - 1 - n / 200] / 1e6, 0);
    if (!(s->high > s->low))
        return;
    s->n = n;
    for (size_t i = 0; i < n; i++) {
        const double part = ((double)value[i] / 1e6 - s->low) / (s->high - s->low) * STRESS_BINS;
        const size_t bin = part < 0 ? 0 : part >= STRESS_BINS ? STRESS_BINS - 1 : (size_t)part;
        s->share[bin] += 100.0 / (double)n;
    }
}

static void add_layers(struct report *r, const struct rock *rock, bool start)
{
    const double h = r->job->domain.spacing_m;
    for (size_t i = 0; rock->layer && rock->viability && i < rock->n; i++)
        if (rock->layer[i] < r->job->n_strata && (!rock->phase || rock->phase[i] == 0)) {
            struct report_layer *l = &r->layer[rock->layer[i]];
            *(start ? &l->start : &l->now) += (double)rock->viability[i] * h * h * h;
        }
}

static status stress_of_points(struct report *r, const struct rock *rock)
{
    status st = OK;
    float *value = NULL;
    size_t n = 0;
    TRY(memory_alloc(rock->n, sizeof *value, "stresses", &value));
    for (size_t i = 0; rock->stress && i < rock->n; i++)
        if (isfinite(rock->stress[i]))
            value[n++] = rock->stress[i];
    r->stress.what = r->job->output.vdb.points == VDB_POINTS_SURFACE ? "surface particles" : "particles";
    fill_bins(&r->stress, value, n);
done:
    free(value);
    return st;
}

static status stress_of_volumes(struct report *r, const char *path)
{
    status st = OK;
    struct frame_grids grids = {0};
    float *value = NULL;
    size_t n = 0;
    TRY(vdb_volumes_read(path, &grids));
    const struct frame_grid *stress = frame_grid_named(&grids, "stress");
    const struct frame_grid *density = frame_grid_named(&grids, "density");
    const size_t samples = grids.bricks.count * BRICK_SAMPLES;
    TRY(memory_alloc(samples, sizeof *value, "stresses", &value));
    for (size_t i = 0; stress && density && i < samples; i++)
        if (density->value[i] > 0 && isfinite(stress->value[i]))
            value[n++] = stress->value[i];
    r->stress.what = "voxels";
    fill_bins(&r->stress, value, n);
done:
    free(value);
    frame_grids_free(&grids);
    return st;
}

/* Fills r->stress from the frame's points or else from its volumes; also the layers, if the points are those of all the rock. */
static status read_points(struct report *r, const struct report_frame *f, bool start)
{
    status st = OK;
    struct path path;
    struct rock rock = {0};
    const bool all = r->job->output.vdb.points == VDB_POINTS_ALL;
    if (manifest_lists(&f->manifest, "points/", ".vdb")) {
        TRY(folder_path(&path, r->root, r->name, FILE_POINTS, f->manifest.frame, NULL));
        TRY(vdb_points_read(path.text, &rock));
        if (all && !r->layer)
            TRY(memory_alloc(r->job->n_strata, sizeof *r->layer, "layers", &r->layer));
        if (all)
            add_layers(r, &rock, start);
        if (!start)
            TRY(stress_of_points(r, &rock));
    } else if (!start) {
        TRY(folder_path(&path, r->root, r->name, FILE_VOLUMES, f->manifest.frame, NULL));
        TRY(stress_of_volumes(r, path.text));
    }
done:
    rock_free(&rock);
    return st;
}

static status find_values(struct report *r)
{
    status st = OK;
    const struct report_frame *first = NULL, *last = NULL;
    for (size_t i = 0; i < r->n_frames; i++)
        if (!r->frame[i].damaged && r->frame[i].has_volumes) {
            first = first ? first : &r->frame[i];
            last = &r->frame[i];
        }
    if (!last)
        return OK;
    r->stress.frame = r->layers_to = last->manifest.frame;
    r->layers_from = first->manifest.frame;
    if (first != last && r->job->output.vdb.points == VDB_POINTS_ALL)
        st = read_points(r, first, true);
    if (st == OK)
        st = read_points(r, last, false);
    if (st != OK && st != E_MEMORY) {
        report_note(r, "No stresses and layers: %s", status_message());
        st = OK;
    }
    if (first == last || r->layers_from != r->frames.first) { /* there is nothing to compare with */
        free(r->layer);
        r->layer = NULL;
    }
    return st;
}

/* ---- run.json and logs */

/* *bytes: a file of log/, or NULL if it cannot be read, since the page can do without it. E_MEMORY. */
static status read_log_file(const struct report *r, const char *name, char **bytes, size_t *n)
{
    struct path path;
    status st = path_join(&path, r->root, name);
    *bytes = NULL;
    *n = 0;
    if (st == OK)
        st = file_read(path.text, LARGEST_LOG, bytes, n);
    return st == E_MEMORY ? st : OK;
}

static status read_timing(struct report *r)
{
    status st = OK;
    char *bytes = NULL;
    size_t n = 0, capacity = 0;
    struct json *json = NULL;
    TRY(read_log_file(r, "log/timing.jsonl", &bytes, &n));
    for (char *line = bytes, *next; line && *line && r->n_timing < MAX_SESSIONS; line = next) {
        next = strchr(line, '\n');
        const size_t length = next ? (size_t)(next - line) : strlen(line);
        next = next ? next + 1 : NULL;
        if (length == 0)
            continue;
        st = json_read(NULL, line, length, &json);
        if (st != OK && st != E_MEMORY) {
            st = OK; /* a truncated line, as a crash of the machine leaves it */
            continue;
        }
        TRY(st);
        TRY(memory_grow(&r->timing, &capacity, r->n_timing + 1, sizeof *r->timing, "timing"));
        r->timing[r->n_timing++] = json;
        json = NULL;
    }
done:
    json_free(&json);
    free(bytes);
    return st;
}

static status read_log(struct report *r)
{
    status st = OK;
    char *bytes = NULL;
    size_t n = 0;
    int lines = 0;
    TRY(read_log_file(r, "log/run.log", &bytes, &n));
    if (!bytes)
        goto done;
    char *from = bytes + n;
    while (from > bytes && lines <= LOG_LINES)
        lines += *--from == '\n' && from + 1 < bytes + n;
    if (lines > LOG_LINES)
        from++;
    TRY(memory_strdup(from, &r->log));
done:
    free(bytes);
    return st;
}

static status read_run(struct report *r)
{
    status st = OK;
    struct path path;
    char *bytes = NULL;
    size_t n = 0;
    TRY(path_join(&path, r->root, "run.json"));
    st = file_read(path.text, 16 << 20, &bytes, &n);
    if (st == OK)
        st = json_read(path.text, bytes, n, &r->run);
    if (st != OK && st != E_MEMORY) {
        report_note(r, "No provenance: %s", status_message());
        st = OK;
    }
done:
    free(bytes);
    return st;
}

status report_gather(const char *root, struct report *r)
{
    status st = OK;
    struct path path;
    *r = (struct report){.root = root};
    TRY(folder_open(root, r->name));
    TRY(path_join(&path, root, "job.yaml"));
    TRY(job_load(path.text, NULL, 0, &r->job));
    r->frames = r->job->frames;
    TRY(find_frames(r));
    TRY(checkpoint_list(root, r->name, &r->checkpoint, &r->n_checkpoints));
    TRY(find_values(r));
    TRY(read_run(r));
    TRY(read_timing(r));
    TRY(read_log(r));
done:
    return st;
}

void report_free(struct report *r)
{
    for (size_t i = 0; i < r->n_frames; i++)
        manifest_free(&r->frame[i].manifest);
    for (size_t i = 0; i < r->n_timing; i++)
        json_free(&r->timing[i]);
    if (r->run)
        json_free(&r->run);
    free(r->frame);
    free(r->timing);
    free(r->checkpoint);
    free(r->layer);
    free(r->log);
    text_free(&r->notes);
    job_destroy(&r->job);
}
