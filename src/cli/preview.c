/* hoodoo preview OUT: POV-Ray stills of frames, and a turntable of one frame. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/cores.h"
#include "base/log.h"
#include "base/memory.h"
#include "cli/await.h"
#include "cli/cli.h"
#include "output/product.h"
#include "render/picture.h"
#include "render/turntable.h"
#include "run/owner.h"
#include "system/atomic_file.h"
#include "system/progress.h"
#include "system/signals.h"

#define ONLY_CHOICE                                                                                          \
    (ONLY_ALL, "all")(ONLY_STILLS, "stills")(ONLY_SHEET, "sheet")(ONLY_VIEWS, "views")(ONLY_VIDEO, "video")( \
        ONLY_WEDGES, "wedges")
enum { CHOICE_CONSTANTS(ONLY_CHOICE) };

struct wanted {
    struct common common;
    bool turntable, keep_scenes, no_slate, figure;
    int views, preset, only, jobs, wedge, show;
    const char *camera, *resolution, *range;
    struct frame_range which; /* views */
    char word[5][128], views_word[32], frames_word[64];
};

/* The options to record with each picture; their strings are stored in `w`. */
static void collect_options(struct wanted *w, struct preview *p)
{
    static const char *const presets[] = {CHOICE_LIST(PRESET_CHOICE)};
    struct option_text {
        const char *name, *value;
    } text[] = {
        {"show", picture_part(p)},     {"range", w->range},
        {"camera", w->camera},         {"preset", w->preset == PRESET_PREVIEW ? NULL : presets[w->preset]},
        {"resolution", w->resolution},
    };
    for (size_t i = 0; i < sizeof text / sizeof *text; i++)
        if (text[i].value) {
            snprintf(w->word[i], sizeof w->word[i], "--%s=%.100s", text[i].name, text[i].value);
            p->option[p->n_options++] = w->word[i];
        }
    if (w->no_slate)
        p->option[p->n_options++] = "--no-slate";
    if (w->figure)
        p->option[p->n_options++] = "--figure";
    if (w->turntable) {
        snprintf(w->views_word, sizeof w->views_word, "--views=%d", w->views);
        p->option[p->n_options++] = w->views_word;
    }
    if (w->common.frames.step) {
        char frames[48];
        snprintf(w->frames_word, sizeof w->frames_word, "--frames=%s", range_text(w->common.frames, frames));
        p->sheet_frames = w->frames_word;
    }
}

static status check(struct wanted *w, struct preview *p)
{
    char rest;
    if (w->resolution && (sscanf(w->resolution, "%dx%d%c", &p->width, &p->height, &rest) != 2 ||
                          p->width < 8 || p->height < 8 || p->width > 16384 || p->height > 16384))
        return fail(E_USAGE, "--resolution %.40s: write WIDTHxHEIGHT, such as 640x360 (8 to 16384)",
                    w->resolution);
    if (w->views < 1 || w->views > 1000)
        return fail(E_USAGE, "--views %d: must be 1 to 1000", w->views);
    bool known = !w->camera;
    for (size_t i = 0; i < p->job->n_cameras; i++)
        known |= w->camera && strcmp(p->job->cameras[i].name, w->camera) == 0;
    if (!known)
        return fail(E_USAGE, "--camera %.60s: the job has no camera of that name", w->camera);
    if (!w->which.step)
        w->which = (struct frame_range){0, w->views - 1, 1};
    if (w->which.first < 0 || w->which.last >= w->views)
        return fail(E_USAGE, "--view %d-%d: must be within 0 to %d (--views %d)", w->which.first,
                    w->which.last, w->views - 1, w->views);
    if (w->range && w->show == 0)
        return fail(E_USAGE, "--range %.40s: choose a value with --show first", w->range);
    w->turntable |= w->only == ONLY_VIEWS || w->only == ONLY_VIDEO;
    if (w->turntable && (w->only == ONLY_STILLS || w->only == ONLY_SHEET))
        return fail(E_USAGE, "--turntable accepts only --only views or --only video");
    p->camera = w->camera;
    p->preset = (enum preset)w->preset;
    p->keep_scenes = w->keep_scenes;
    p->no_slate = w->no_slate;
    p->figure = w->figure;
    p->show = show_of_word(w->show);
    p->range = show_job_range(p->show, p->job);
    collect_options(w, p);
    if (w->range && strcmp(w->range, "job") != 0 && strcmp(w->range, "data") != 0)
        return show_parse_range(p->show, w->range, &p->range);
    return OK;
}

/* Keeps only the frames that have stills. */
static status keep_those_with_stills(const struct preview *p, int *frames, size_t *n)
{
    status st = OK;
    struct path path;
    size_t k = 0;
    for (size_t i = 0; i < *n; i++) {
        TRY(picture_still_path(p, frames[i], &path));
        TRY(path_join(&path, p->root, path.text));
        if (access(path.text, R_OK) == 0)
            frames[k++] = frames[i];
    }
    *n = k;
done:
    return st;
}

static status stills(struct preview *p, int *frames, size_t n, int only)
{
    status st = OK;
    char line[64];
    for (size_t i = 0; i < n && only != ONLY_SHEET; i++) {
        TRY(picture_still(p, frames[i]));
        snprintf(line, sizeof line, "still of frame %d", frames[i]);
        progress_note(p->progress, i, n, line); /* still running */
    }
    TRY(children_wait(&p->children));
    if (only == ONLY_STILLS)
        goto done;
    if (only == ONLY_SHEET)
        await_stills(p);
    TRY(keep_those_with_stills(p, frames, &n));
    if (n == 0)
        st =
            fail(E_INPUT, "%s: no stills of these frames; run 'hoodoo preview --only stills' first", p->root);
    else
        TRY(turntable_contact(p, frames, n, 0));
done:
    return st;
}

/* Whether an undamaged contact sheet of stills exists. */
static status has_stills_sheet(const struct preview *p, const char *path, bool *out)
{
    struct product sheet;
    status st = product_read(p->root, path, &sheet);
    if (st == OK)
        st = product_check(p->root, p->job->name, &sheet, true);
    *out = st == OK && sheet.frame == ALL_FRAMES;
    product_free(&sheet);
    return st == E_INPUT ? OK : st;
}

static status turntable(struct preview *p, const struct wanted *w, const int *frames, size_t n)
{
    status st = OK;
    struct path path;
    bool of_stills;
    if (w->only != ONLY_VIDEO)
        TRY(picture_orbit(p, frames[n - 1], w->views, w->which));
    if (w->only == ONLY_VIEWS)
        goto done;
    if (w->only == ONLY_VIDEO)
        await_views(p, frames[n - 1], w->views);
    TRY(turntable_video(p, frames[n - 1], w->views));
    /* A sheet of stills is more informative than one of views and is not replaced by it. */
    TRY(folder_name(&path, p->job->name, FILE_SHEET, 0, picture_part(p)));
    TRY(has_stills_sheet(p, path.text, &of_stills));
    if (!of_stills)
        TRY(turntable_contact(p, frames, n, w->views));
done:
    return st;
}

static status make_folder(const char *root, const char *name)
{
    status st = OK;
    struct path path;
    TRY(path_join(&path, root, name));
    TRY(folder_make(path.text));
done:
    return st;
}

/* Removes temporary files of programs that failed or were killed. */
static void sweep_all(const char *root)
{
    static const char *const folders[] = {"", "preview", "turntable"};
    struct path path;
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++)
        if (path_join(&path, root, folders[i]) == OK)
            atomic_file_sweep_own(path.text);
}

/* The sheet across the wedges of a farm's folder. */
static status wedges(struct preview *p)
{
    status st = OK;
    struct path path;
    struct job *base = NULL;
    const struct job **all = NULL;
    struct job *one = NULL;
    size_t n = 0;
    TRY(path_join(&path, p->root, "farm/job.yaml"));
    TRY(job_load(path.text, NULL, 0, &base));
    size_t n_wedges = job_wedges(base);
    TRY(memory_alloc(n_wedges, sizeof *all, "the wedges", &all));
    for (; n < n_wedges; n++) {
        TRY(job_load_wedge(path.text, NULL, 0, base, (int)n + 1, &one));
        all[n] = one;
    }
    p->job = base;
    signals_install();
    folder_sweep(p->root);
    TRY(make_folder(p->root, "log"));
    children_begin(&p->children, p->root, "log/preview.log", PICTURE_PACKAGES, 1);
    await_wedges(p->root, all, n);
    TRY(turntable_wedges(p, all, n));
done:
    children_end(&p->children);
    while (n > 0) {
        one = (struct job *)(uintptr_t)all[--n];
        job_destroy(&one);
    }
    free(all);
    job_destroy(&base);
    return st;
}

status cli_preview(int argc, char **argv)
{
    status st = OK;
    struct wanted w = {.views = 72, .preset = PRESET_PREVIEW, .jobs = cores()};
    struct arguments operands = {0};
    struct job *job = NULL;
    struct job_states states = {0};
    struct preview p = {0};
    struct progress progress = {0};
    int *frames = NULL;
    size_t n;
    struct path root, path;
    char name[256];
    char shown[SHOW_WORDS];
    bool help = false;
    const struct option options[] = {
        OPTION_FRAMES(&w.common),
        {"turntable", NULL, OPTION_FLAG, &w.turntable,
         "a full orbit around the last frame, as pictures and a video"},
        {"views", "N", OPTION_INT, &w.views, "pictures in the orbit, a video of 6 seconds (default: 72)"},
        {"view", "RANGE", OPTION_RANGE, &w.which,
         "render only these views, such as 0-11, with --only views, so that several machines can share an orbit (default: all)"},
        {"show", show_words(shown), OPTION_CHOICE, &w.show,
         "a value of the surface in false colours, with a legend (default: rock, its natural colours)"},
        {"range", "job|data|LO:HI", OPTION_TEXT, &w.range,
         "range of the colours. job: one range for all pictures of a job (stress from the weight of the rock, discharge from its water, erodibility from its strata, shares from 0 to 1); data: from the 1st to the 99th percentile of the values in these frames; LO:HI: given in the legend's unit (default: job)"},
        {"camera", "NAME", OPTION_TEXT, &w.camera, "a camera of the job (default: the first)"},
        {"preset", CHOICE_TEXT(PRESET_CHOICE), OPTION_CHOICE, &w.preset,
         "rendering quality (default: preview)"},
        {"resolution", "WxH", OPTION_TEXT, &w.resolution,
         "size of the pictures (default: stills as the camera, at most 960x540 unless final; views 640x360, 1280x720 or 1920x1080 by preset)"},
        {"only", CHOICE_TEXT(ONLY_CHOICE), OPTION_CHOICE, &w.only,
         "make only a part. stills: without a contact sheet; sheet: of existing stills; views: of the turntable, without a video; video: of existing views; wedges: the sheet across the wedges of a farm's folder"},
        {"figure", NULL, OPTION_FLAG, &w.figure, "add a person of 1.75 m in front of the rock"},
        {"no-slate", NULL, OPTION_FLAG, &w.no_slate,
         "omit the scale bar and the strip with name, frame and age (pictures lower than 120 pixels never have them)"},
        OPTION_WEDGE(&w.wedge),
        OPTION_PROGRESS(&w.common),
        {"jobs", "N", OPTION_INT, &w.jobs, "pictures rendered in parallel (default: one per core)"},
        {"keep-scenes", NULL, OPTION_FLAG, &w.keep_scenes, "keep the POV-Ray scenes beside the pictures"},
    };
    TRY(options_parse(&usage_preview, options, sizeof options / sizeof *options, argc, argv, &operands,
                      &help));
    if (help)
        goto done;
    TRY(wedge_folder(operands.item[0], w.wedge, &root));
    p.root = root.text;
    if (w.jobs < 1) {
        st = fail(E_USAGE, "--jobs %d: must be 1 or more", w.jobs);
        goto done;
    }
    if (w.only == ONLY_WEDGES) {
        st = wedges(&p);
        goto done;
    }
    TRY(frames_folder(p.root, w.common.frames, name));
    TRY(path_join(&path, p.root, "job.yaml"));
    TRY(job_load(path.text, NULL, 0, &job));
    p.job = job;
    TRY(owner_check_frames(p.root, job->name, w.common.frames, &states));
    TRY(check(&w, &p));
    TRY(volume_frames(p.root, p.job->name, w.common.frames, &frames, &n));
    folder_sweep(p.root);
    TRY(make_folder(p.root, "log"));
    TRY(make_folder(p.root, w.turntable ? "turntable" : "preview"));
    signals_install();
    progress_begin_notes(&progress, (enum progress_style)w.common.progress);
    p.progress = &progress;
    children_begin(&p.children, p.root, "log/preview.log", PICTURE_PACKAGES, w.jobs);
    if (w.range && strcmp(w.range, "data") == 0)
        TRY(picture_data_range(&p, w.turntable ? frames + n - 1 : frames, w.turntable ? 1 : n, &p.range));
    TRY(w.turntable ? turntable(&p, &w, frames, n) : stills(&p, frames, n, w.only));
    progress_note(&progress, n, n, w.turntable ? "turntable made" : "pictures made");
    if (progress.style == PROGRESS_BAR)
        log_info("%s are in %s/%s", w.turntable ? "the views" : "the stills", p.root,
                 w.turntable ? "turntable" : "preview");
done:
    progress_end(&progress);
    children_end(&p.children);
    pictures_end(&p);
    if (st != OK && p.root)
        sweep_all(p.root);
    free(frames);
    job_states_free(&states);
    job_destroy(&job);
    arguments_free(&operands);
    common_free(&w.common);
    return st;
}
