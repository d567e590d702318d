/* hoodoo preview OUT: POV-Ray stills of frames, and the turntable of one. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/log.h"
#include "cli/cli.h"
#include "cli/signals.h"
#include "output/folder.h"
#include "render/picture.h"
#include "render/turntable.h"

struct wanted {
    struct common common;
    bool turntable, keep_scenes;
    int views, preset;
    const char *camera, *resolution;
};

static status check(const struct wanted *w, struct preview *p)
{
    char rest;
    if (w->resolution && (sscanf(w->resolution, "%dx%d%c", &p->width, &p->height, &rest) != 2 ||
                          p->width < 8 || p->height < 8 || p->width > 16384 || p->height > 16384))
        return fail(E_USAGE, "--resolution %.40s: write WIDTHxHEIGHT, such as 640x360 (8 to 16384)",
                    w->resolution);
    if (w->views < 1 || w->views > 1000)
        return fail(E_USAGE, "--views %d: 1 to 1000", w->views);
    bool known = !w->camera;
    for (size_t i = 0; i < p->job->n_cameras; i++)
        known |= w->camera && strcmp(p->job->cameras[i].name, w->camera) == 0;
    if (!known)
        return fail(E_USAGE, "--camera %.60s: the job has no camera of that name", w->camera);
    p->camera = w->camera;
    p->preset = (enum preset)w->preset;
    p->keep_scenes = w->keep_scenes;
    return OK;
}

static status stills(struct preview *p, const int *frames, size_t n)
{
    status st = OK;
    for (size_t i = 0; i < n; i++)
        TRY(picture_still(p, frames[i]));
    TRY(children_wait(&p->children));
    TRY(turntable_contact(p, frames, n, 0));
done:
    return st;
}

static status turntable(struct preview *p, const int *frames, size_t n, int views)
{
    status st = OK;
    char path[4700];
    TRY(picture_orbit(p, frames[n - 1], views));
    TRY(turntable_video(p, frames[n - 1], views));
    /* A sheet of stills says more than one of views, if there is one. */
    snprintf(path, sizeof path, "%s/%s.contact.png", p->root, p->job->name);
    if (access(path, R_OK) != 0)
        TRY(turntable_contact(p, frames, n, views));
done:
    return st;
}

static status make_folder(const char *root, const char *name)
{
    char path[4700];
    snprintf(path, sizeof path, "%s/%s", root, name);
    status st = folder_make(path);
    if (st == OK)
        atomic_file_sweep(path);
    return st;
}

static int cores(void)
{
    long n = sysconf(_SC_NPROCESSORS_ONLN);
    return n > 0 ? (int)n : 1;
}

status cli_preview(int argc, char **argv)
{
    status st = OK;
    struct wanted w = {.views = 36, .preset = PRESET_PREVIEW};
    struct words operands = {0};
    struct job *job = NULL;
    struct preview p = {0};
    int *frames = NULL;
    size_t n;
    char name[256], path[4700];
    bool help = false;
    const struct option options[] = {
        OPTION_FRAMES(&w.common),
        {"turntable", NULL, OPTION_FLAG, &w.turntable,
         "a full orbit of the last frame, as pictures and video"},
        {"views", "N", OPTION_INT, &w.views, "pictures in the orbit (default 36)"},
        {"camera", "NAME", OPTION_TEXT, &w.camera, "of the job (default: its first)"},
        {"preset", "draft|preview|final", OPTION_CHOICE, &w.preset,
         "how much care is taken (default preview)"},
        {"resolution", "WxH", OPTION_TEXT, &w.resolution, "of the pictures (default: the preset's)"},
        {"keep-scenes", NULL, OPTION_FLAG, &w.keep_scenes, "leave the POV-Ray scenes beside the pictures"},
    };
    TRY(options_parse(&usage_preview, options, sizeof options / sizeof *options, argc, argv, &operands,
                      &help));
    if (help)
        goto done;
    p.root = operands.word[0];
    TRY(folder_open(p.root, name));
    snprintf(path, sizeof path, "%.4096s/job.yaml", p.root);
    TRY(job_load(path, NULL, 0, &job));
    p.job = job;
    TRY(check(&w, &p));
    TRY(volume_frames(p.root, p.job->name, w.common.frames, &frames, &n));
    TRY(make_folder(p.root, "log"));
    TRY(make_folder(p.root, w.turntable ? "turntable" : "preview"));
    signals_install();
    children_begin(&p.children, p.root, "log/preview.log", cores());
    TRY(w.turntable ? turntable(&p, frames, n, w.views) : stills(&p, frames, n));
done:
    children_end(&p.children);
    free(frames);
    job_destroy(&job);
    words_free(&operands);
    common_free(&w.common);
    return st;
}
