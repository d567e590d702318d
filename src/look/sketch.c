#include "look/sketch.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/log.h"
#include "base/memory.h"
#include "model/model.h"
#include "render/view.h"
#include "run/advice.h"
#include "run/branch.h"
#include "text/text.h"

/* Seconds of a frame, at least. */
static const double FRAME_SECONDS = 0.025;

/* ---- settings that replace the job's own */

enum { SETS_MOST = 16 };

struct sets {
    const char **word; /* the user's --set first, then ours */
    size_t n, n_user;
    struct text text[SETS_MOST];
};

static status sets_begin(const struct sketch_options *o, struct sets *s)
{
    status st = OK;
    *s = (struct sets){.n = o->n_sets, .n_user = o->n_sets};
    TRY(memory_alloc(o->n_sets + SETS_MOST, sizeof *s->word, "settings", &s->word));
    for (size_t i = 0; i < o->n_sets; i++)
        s->word[i] = o->sets[i];
done:
    return st;
}

static void sets_free(struct sets *s)
{
    for (size_t i = s->n_user; i < s->n; i++)
        text_free(&s->text[i - s->n_user]);
    free(s->word);
}

/* Adds a setting; its text must be filled in before sets_ready(). */
static struct text *sets_more(struct sets *s)
{
    return &s->text[s->n++ - s->n_user];
}

static status sets_ready(struct sets *s)
{
    status st = OK;
    for (size_t i = s->n_user; i < s->n; i++) {
        TRY(text_status(&s->text[i - s->n_user]));
        s->word[i] = s->text[i - s->n_user].data;
    }
done:
    return st;
}

/* ---- the camera */

/* "AZIMUTH,ELEVATION" */
static bool parse_direction(const char *text, double *azimuth, double *elevation)
{
    char rest;
    return text && sscanf(text, "%lf,%lf%c", azimuth, elevation, &rest) == 2 && fabs(*azimuth) <= 36000 &&
           fabs(*elevation) <= 90;
}

/* The camera's shape, no wider than the requested width. */
static void limit(const double resolution[2], int width, int out[2])
{
    const double share = fmin(1, width / resolution[0]);
    for (int i = 0; i < 2; i++)
        out[i] = (int)fmax(8, round(resolution[i] * share));
}

static status set_camera(const struct job *job, const struct sketch_options *o, struct sets *s, char name[72])
{
    double azimuth = -55, elevation = 9;
    const bool direction = parse_direction(o->camera, &azimuth, &elevation);
    int size[2];
    size_t at = 0;
    while (!direction && o->camera && at < job->n_cameras && strcmp(job->cameras[at].name, o->camera) != 0)
        at++;
    if (!direction && o->camera && at == job->n_cameras)
        return fail(
            E_USAGE,
            "--camera %.60s: the job has no camera of that name; a direction is AZIMUTH,ELEVATION in degrees, such as -55,9",
            o->camera);
    if (direction || job->n_cameras == 0) {
        const double wide[2] = {960, 540};
        limit(wide, o->width, size);
        const struct camera c = view_around(job, azimuth, elevation, size[0], size[1]);
        snprintf(name, 72, "look");
        text_add(
            sets_more(s),
            "cameras.look={position_m: [%.17g, %.17g, %.17g], target_m: [%.17g, %.17g, %.17g], focal_mm: %.17g, aperture_mm: 36, resolution: [%d, %d]}",
            c.eye[0], c.eye[1], c.eye[2], c.eye[0] + c.ahead[0], c.eye[1] + c.ahead[1], c.eye[2] + c.ahead[2],
            35 * (o->zoom > 0 ? o->zoom : 1), size[0], size[1]);
    } else {
        const struct job_camera *c = &job->cameras[at];
        limit(c->resolution, o->width, size);
        snprintf(name, 72, "%s", c->name);
        text_add(sets_more(s), "cameras.%s.resolution=[%d, %d]", name, size[0], size[1]);
        text_add(sets_more(s), "cameras.%s.overscan=0", name);
    }
    return OK;
}

/* ---- the frame */

static status choose_frame(const struct job *job, const char *text, int *out)
{
    char frames[48], *end;
    const long frame = text ? strtol(text, &end, 10) : 0;
    *out = job->frames.last;
    if (!text || strcmp(text, "last") == 0)
        return OK;
    if (*end || end == text || frame < job->frames.first || frame > job->frames.last)
        return fail(E_USAGE, "--frame %.40s: the job's frames are %s; or write last", text,
                    range_text(job->frames, frames));
    *out = (int)frame;
    return OK;
}

/* ---- the spacing */

static double seconds_of(const struct job *job, double work, int frames, bool gpu)
{
    return FRAME_SECONDS * frames + job_model(job)->step_seconds * work / (gpu ? LOOK_GPU : 1);
}

/* Particles times steps at `times` the job's spacing. The number of particles follows from the volume, and the number of steps from the
 * retreat in voxels, with at least one step per frame. */
static double work_at(const struct model_estimate *e, double frames, double factor)
{
    return (double)e->n_particles / (factor * factor * factor) * fmax(e->steps / factor, frames);
}

static double choose_factor(const struct job *job, const struct model_estimate *e, int frames, double seconds,
                            bool gpu)
{
    static const double factors[] = {1, 1.5, 2, 3, 4, 6, 8, 12, 16, 24, 32};
    enum { N = sizeof factors / sizeof *factors };
    double factor = 1;
    for (int i = 0; i < N && (double)e->n_particles / pow(factors[i], 3) >= (i ? LOOK_LEAST : 0); i++) {
        factor = factors[i];
        if (seconds_of(job, work_at(e, frames, factor), frames, gpu) <= seconds)
            break;
    }
    return factor;
}

static status set_spacing(const struct job *job, const struct sketch_options *o, struct sets *s,
                          struct sketch *out)
{
    status st = OK;
    const int frames = out->frame - job->frames.first, all = job->frames.last - job->frames.first;
    const double *size = job->domain.size_m, own = job->domain.spacing_m;
    struct model_estimate e;
    double factor = 1;
    TRY(model_estimate(job, &e));
    out->own_estimate = e;
    out->own_seconds = seconds_of(job, work_at(&e, all, 1), all, o->gpu);
    e.steps *= (double)frames / fmax(job->frames.last - job->frames.first, 1);
    if (o->spacing_m > 0)
        factor = o->spacing_m / own;
    else if (isfinite(o->seconds) && !*job->from)
        factor = choose_factor(job, &e, frames, o->seconds, o->gpu);
    out->own_spacing_m = own;
    if (factor == 1 && o->spacing_m <= 0)
        goto done;
    text_add(sets_more(s), "domain.spacing_m=%.17g", own * factor);
    if (job->arches.cell_m > 0)
        text_add(sets_more(s), "arches.cell_m=%.17g", job->arches.cell_m * factor);
    if (job->wind.flow.solver == FLOW_SPH)
        text_add(sets_more(s), "wind.flow.spacing_m=%.17g",
                 fmax(job->wind.flow.spacing_m, fmax(fmax(size[0], size[1]), size[2]) / 6));
done:
    return st;
}

/* ---- the job */

static status load(const struct sketch_options *o, const char *const *sets, size_t n, struct job **out)
{
    status st = OK;
    struct job *base = NULL;
    TRY(job_load(o->path, sets, n, &base));
    if (o->wedge) {
        TRY(job_load_wedge(o->path, sets, n, base, o->wedge, out));
    } else {
        *out = base;
        base = NULL;
    }
    if (o->from)
        TRY(branch_from(*out, o->from, ""));
    TRY(branch_prepare(*out, ""));
done:
    job_destroy(&base);
    if (st != OK)
        job_destroy(out);
    return st;
}

static void set_pictures(const struct sketch_options *o, const char *camera, struct sets *s)
{
    text_add(sets_more(s), "output.aov.cameras=[%s]", camera);
    if (o->all_layers)
        text_add(sets_more(s), "output.aov.layers=[]");
    else
        text_add(sets_more(s), "output.aov.layers=[rgba, depth, N, P%s%s]", o->show ? ", " : "",
                 o->show ? value_table[o->show].layer : "");
    text_add(sets_more(s), "output.aov.samples=%d", o->samples);
    text_add(sets_more(s), "output.aov.cryptomatte=false");
    text_add(sets_more(s), "output.up=z");
}

status sketch_read_job(const struct sketch_options *o, struct job **out)
{
    return load(o, o->sets, o->n_sets, out);
}

status sketch_load(const struct sketch_options *o, struct sketch *out)
{
    status st = OK;
    struct job *job = NULL;
    struct sets sets = {0};
    char camera[72];
    bool hushed;
    *out = (struct sketch){0};
    TRY(load(o, o->sets, o->n_sets, &job));
    TRY(choose_frame(job, o->frame, &out->frame));
    TRY(sets_begin(o, &sets));
    TRY(set_camera(job, o, &sets, camera));
    TRY(set_spacing(job, o, &sets, out));
    set_pictures(o, camera, &sets);
    TRY(sets_ready(&sets));
    hushed = log_silence(true); /* it has been said */
    st = load(o, sets.word, sets.n, &out->job);
    log_silence(hushed);
    TRY(st);
    for (size_t i = 0; i < out->job->n_cameras; i++)
        if (strcmp(out->job->cameras[i].name, camera) == 0)
            out->camera = &out->job->cameras[i];
    out->own = job;
    job = NULL;
done:
    sets_free(&sets);
    job_destroy(&job);
    if (st != OK)
        sketch_free(out);
    return st;
}

static bool has(const struct advice_list *all, const struct advice *a)
{
    bool found = false;
    for (size_t i = 0; i < all->n; i++)
        found |= strcmp(all->item[i].key, a->key) == 0;
    return found;
}

status sketch_loses(const struct sketch *s, struct text *out)
{
    status st = OK;
    struct advice_list coarse = {0}, own = {0};
    const bool hushed = log_silence(true);
    if (s->job->domain.spacing_m > s->own_spacing_m) {
        TRY(advice_collect(s->job, true, &coarse));
        TRY(advice_collect(s->own, true, &own));
    }
    for (size_t i = 0; i < coarse.n; i++)
        if (!has(&own, &coarse.item[i]))
            text_add(out, "%s: %s\n", coarse.item[i].key, coarse.item[i].text);
    TRY(text_status(out));
done:
    log_silence(hushed);
    advice_free(&coarse);
    advice_free(&own);
    return st;
}

void sketch_free(struct sketch *s)
{
    job_destroy(&s->own);
    job_destroy(&s->job);
}
