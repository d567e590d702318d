/* hoodoo status OUT: reports the frames of an output folder, from manifests and sizes alone, and their rate, from its log. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/memory.h"
#include "checkpoint/checkpoint.h"
#include "cli/answer.h"
#include "cli/cli.h"
#include "farm/end.h"
#include "farm/status.h"
#include "output/folder.h"
#include "run/timing.h"

enum { STATE_MISSING, STATE_DONE, STATE_DAMAGED, N_STATES };

struct survey {
    const char *root;
    char name[256];
    struct frame_range frames;
    unsigned char *state; /* [range_count(frames)] */
    char (*bad)[512];     /* [n[STATE_DAMAGED]]: the problem of each damaged frame, in order of frames */
    double written;       /* when the newest manifest was written, s */
    size_t n[N_STATES], bad_capacity;
};

static double modified(const struct survey *s, int frame)
{
    struct path path;
    struct stat info;
    if (folder_path(&path, s->root, s->name, FILE_MANIFEST, frame, NULL) != OK || stat(path.text, &info) != 0)
        return 0;
    return (double)info.st_mtim.tv_sec + 1e-9 * (double)info.st_mtim.tv_nsec;
}

static status survey_frame(struct survey *s, int frame, size_t i)
{
    struct manifest manifest = {0};
    const char *bad = "";
    status st = manifest_read(s->root, s->name, frame, &manifest);
    if (st == OK)
        st = manifest_check(s->root, &manifest, false, &bad);
    if (st == E_MEMORY)
        goto done;
    bool damaged = st != OK || *bad;
    s->state[i] = damaged ? STATE_DAMAGED : STATE_DONE;
    st = OK;
    if (damaged) {
        size_t k = s->n[STATE_DAMAGED];
        TRY(memory_grow(&s->bad, &s->bad_capacity, k + 1, sizeof *s->bad, "the damaged frames"));
        snprintf(s->bad[k], sizeof s->bad[k], "%s", status_message());
    } else {
        s->written = fmax(s->written, modified(s, frame));
    }
    s->n[s->state[i]]++;
done:
    manifest_free(&manifest);
    return st;
}

static status survey_frames(struct survey *s)
{
    status st = OK;
    int *there = NULL;
    size_t n_there, total = range_count(s->frames);
    TRY(folder_frames(s->root, s->name, &there, &n_there));
    TRY(memory_alloc(total, sizeof *s->state, "the frames", &s->state));
    for (size_t i = 0; i < n_there; i++)
        if (range_holds(s->frames, there[i]))
            TRY(survey_frame(s, there[i], (size_t)((there[i] - s->frames.first) / s->frames.step)));
    s->n[STATE_MISSING] = total - s->n[STATE_DONE] - s->n[STATE_DAMAGED];
done:
    free(there);
    return st;
}

/* ---- the answer */

/* The frames in `state`, as ranges. */
static void add_ranges(const struct survey *s, int state, const char *key, struct text *out)
{
    size_t total = range_count(s->frames);
    char text[48];
    json_array(out, key);
    for (size_t i = 0; i < total; i++) {
        size_t first = i;
        if (s->state[i] != state)
            continue;
        while (i + 1 < total && s->state[i + 1] == state)
            i++;
        struct frame_range r = {s->frames.first + (int)first * s->frames.step,
                                s->frames.first + (int)i * s->frames.step, s->frames.step};
        json_text(out, NULL, range_text(r, text));
    }
    json_end_array(out);
}

static void add_damaged(const struct survey *s, struct text *out)
{
    size_t k = 0;
    json_array(out, "damage");
    for (size_t i = 0; k < s->n[STATE_DAMAGED]; i++) {
        if (s->state[i] != STATE_DAMAGED)
            continue;
        json_object(out, NULL);
        json_integer(out, "frame", s->frames.first + (int)i * s->frames.step);
        json_text(out, "what", s->bad[k++]);
        json_end_object(out);
    }
    json_end_array(out);
}

static status add_rate(const struct survey *s, struct text *out)
{
    status st = OK;
    const double now = (double)time(NULL);
    double each;
    TRY(timing_frame_seconds(s->root, &each));
    if (each > 0) {
        json_number(out, "frames_per_second", (double)(int64_t)(1e4 / each) / 1e4);
        json_integer(out, "time_left_seconds",
                     (int64_t)((double)(s->n[STATE_MISSING] + s->n[STATE_DAMAGED]) * each));
    }
    if (s->n[STATE_DONE])
        json_integer(out, "since_last_frame_seconds", (int64_t)(now > s->written ? now - s->written : 0));
done:
    return st;
}

static status add_checkpoints(const struct survey *s, struct text *out)
{
    int *frames = NULL;
    size_t n;
    status st = checkpoint_list(s->root, s->name, &frames, &n);
    json_array(out, "checkpoints");
    for (size_t i = 0; st == OK && i < n; i++)
        json_integer(out, NULL, frames[i]);
    json_end_array(out);
    free(frames);
    return st;
}

static status answer_status(struct survey *s, bool words, struct text *out)
{
    status st = OK;
    char text[48];
    answer_begin(out);
    json_text(out, "folder", s->root);
    json_text(out, "name", s->name);
    json_text(out, "frames", range_text(s->frames, text));
    json_integer(out, "total", (int64_t)range_count(s->frames));
    json_integer(out, "done", (int64_t)s->n[STATE_DONE]);
    json_integer(out, "missing", (int64_t)s->n[STATE_MISSING]);
    json_integer(out, "damaged", (int64_t)s->n[STATE_DAMAGED]);
    json_text(out, "checked", "names and sizes"); /* hoodoo verify reads the contents */
    add_ranges(s, STATE_DONE, "frames_done", out);
    add_ranges(s, STATE_MISSING, "frames_missing", out);
    add_ranges(s, STATE_DAMAGED, "frames_damaged", out);
    TRY(add_checkpoints(s, out));
    TRY(add_rate(s, out));
    if (s->n[STATE_DAMAGED])
        add_damaged(s, out);
    if (farm_is(s->root))
        TRY(farm_status(s->root, words, out));
    json_end_object(out);
done:
    return st;
}

/* Whether any run has started in this folder. */
static bool begun(const char *root)
{
    struct path path;
    return path_join(&path, root, "run.json") == OK && access(path.text, F_OK) == 0;
}

/* A farm's folder that holds no frames, or holds them in folders of its wedges. */
static status answer_farm(const char *root, bool words, struct text *out)
{
    answer_begin(out);
    json_text(out, "folder", root);
    status st = farm_status(root, words, out);
    json_end_object(out);
    return st;
}

status cli_status(int argc, char **argv)
{
    status st = OK;
    struct common c = {0};
    struct arguments operands = {0};
    struct survey s = {0};
    struct text answer = {0};
    bool help, wedges, end = false;
    const struct option options[] = {
        OPTION_FRAMES(&c),
        OPTION_JSON(&c),
        {"end", NULL, OPTION_FLAG, &end,
         "of a submitted job: run farm.on_done, unless it was run for this end, and exit with 0 if every task is done, else with 4. The last task of a job runs this"}};
    TRY(options_parse(&usage_status, options, sizeof options / sizeof *options, argc, argv, &operands,
                      &help));
    if (help)
        goto done;
    s.root = operands.item[0];
    if (end) {
        TRY(farm_end(s.root));
        goto done;
    }
    TRY(farm_has_wedges(s.root, &wedges));
    if (wedges || (farm_is(s.root) && !begun(s.root))) {
        TRY(answer_farm(s.root, !c.json, &answer));
        TRY(answer_print(&answer, c.json));
        goto done;
    }
    TRY(folder_open(s.root, s.name));
    s.frames = c.frames;
    if (s.frames.step == 0)
        TRY(job_frames(s.root, &s.frames));
    TRY(survey_frames(&s));
    TRY(answer_status(&s, !c.json, &answer));
    TRY(answer_print(&answer, c.json));
done:
    text_free(&answer);
    free(s.state);
    free(s.bad);
    arguments_free(&operands);
    return st;
}
