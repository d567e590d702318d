#include "look/look.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/log.h"
#include "base/memory.h"
#include "gpu/gpu.h"
#include "look/figure.h"
#include "look/gizmos.h"
#include "look/history.h"
#include "look/print.h"
#include "look/shot.h"
#include "look/states.h"
#include "model/model.h"
#include "run/branch.h"
#include "run/memory.h"

/* About so many states of a run are kept, evenly spaced, besides that of the requested frame. */
enum { KEPT_STATES = 16 };

struct look {
    struct gpu *gpu;
    struct states states;
    struct frame last;   /* the frame of the last picture, for look_at() */
    struct sketch shown; /* its job, for look_curves() */
    struct history history;
};

/* Looks that may take at most this long are of few particles. With them, half of the time of two threads went into waking each other. */
static const double FEW_SECONDS = 5;

status look_begin(const char *device, double seconds, struct look **out)
{
    status st = OK;
    struct look *l = NULL;
    if (seconds <= FEW_SECONDS)
        setenv("LP_NUM_THREADS", "0", 0);
    TRY(memory_alloc(1, sizeof *l, "a look", &l));
    TRY(gpu_create(&(struct gpu_options){.device = device}, &l->gpu));
    states_open(gpu_info(l->gpu), &l->states);
    *out = l;
    l = NULL;
done:
    look_end(&l);
    return st;
}

void look_end(struct look **look)
{
    if (!*look)
        return;
    states_trim(&(*look)->states);
    frame_free(&(*look)->last);
    sketch_free(&(*look)->shown);
    history_free(&(*look)->history);
    gpu_destroy(&(*look)->gpu);
    free(*look);
    *look = NULL;
}

bool look_on_gpu(const struct look *look)
{
    return !gpu_info(look->gpu)->is_cpu;
}

void look_made_free(struct look_made *made)
{
    free(made->png);
    text_free(&made->gizmos);
    text_free(&made->coarse);
}

/* ---- the state */

/* *out: the model in the latest frame with a cached state, or else in the job's first frame. */
static status load_latest_state(struct look *l, const struct sketch *s, const uint64_t *hash,
                                struct look_made *made, struct model **out)
{
    status st = OK;
    const size_t n = (size_t)(s->frame - s->job->frames.first) + 1;
    struct model_estimate e;
    struct branch_state c = {0};
    TRY(run_memory_check(l->gpu, s->job, &e));
    made->n_particles = e.n_particles;
    for (size_t at = n; !*out;) {
        at = states_find(&l->states, hash, at, &c.at);
        made->found = at < n;
        if (!made->found && *s->job->from)
            TRY(branch_load(s->job, &c));
        if (made->found)
            TRY(history_take(&l->history, &c.at));
        st = model_create(l->gpu, s->job, made->found || *s->job->from ? &c.at : NULL, out);
        checkpoint_free(&c.at);
        if (st != E_CHECKPOINT || !made->found)
            break;
        states_drop(&l->states, hash[at]);
    }
    made->began = *out ? model_frame(*out) : 0;
done:
    return st;
}

/* Keeps the model's state; `hash` has those of its frame and of all frames before. */
static status keep_state(struct look *l, const struct sketch *s, struct model *m, const uint64_t *hash)
{
    status st = OK;
    struct checkpoint c = {0};
    const size_t at = (size_t)(model_frame(m) - s->job->frames.first);
    if (states_has(&l->states, hash[at]))
        return OK;
    TRY(model_save(m, &c));
    TRY(history_give(&l->history, hash, at + 1, &c));
    states_keep(&l->states, hash[at], &c);
done:
    checkpoint_free(&c);
    return st;
}

static status note_numbers(struct look *l, struct model *m, uint64_t hash)
{
    status st = OK;
    struct frame frame = {0};
    if (history_has(&l->history, hash))
        return OK;
    TRY(model_measure(m, &frame));
    TRY(history_note(&l->history, hash, &frame));
done:
    frame_free(&frame);
    return st;
}

static status simulate_to_frame(struct look *l, const struct sketch *s, const struct look_options *o,
                                struct look_made *made, struct model **out)
{
    status st = OK;
    const int first = s->job->frames.first,
              stride = (int)fmax(1, ceil((double)(s->frame - first) / KEPT_STATES));
    uint64_t *hash = NULL;
    TRY(memory_alloc((size_t)(s->frame - first) + 1, sizeof *hash, "hashes of frames", &hash));
    TRY(job_frame_hashes(s->job, s->frame, hash));
    TRY(load_latest_state(l, s, hash, made, out));
    if (o->begin)
        o->begin(o->user, (struct frame_range){made->began, s->frame, 1});
    for (;;) {
        const int frame = model_frame(*out);
        TRY(note_numbers(l, *out, hash[frame - first]));
        if ((frame - first) % stride == 0 || frame == s->frame)
            TRY(keep_state(l, s, *out, hash));
        if (frame == s->frame)
            break;
        if (o->stop && o->stop(o->user)) {
            TRY(keep_state(l, s, *out, hash));
            st = fail(STOPPED,
                      "stopped after frame %d, whose state is cached; run the same command again to continue",
                      frame);
            goto done;
        }
        TRY(model_step(*out));
        if (o->frame)
            o->frame(o->user, frame + 1);
    }
done:
    free(hash);
    return st;
}

/* ---- the picture */

/* "AXIS=METRES". The side of the camera is cut off, or what is above. */
static status parse_cut(const struct job *job, const struct camera *camera, const char *text,
                        struct field_cut *out)
{
    static const char axes[] = "xyz";
    const char *letter = text[0] ? strchr(axes, text[0]) : NULL;
    char rest;
    double at = 0;
    if (!letter || sscanf(text + 1, "=%lf%c", &at, &rest) != 1)
        return fail(E_USAGE, "--cut %.40s: write x=, y= or z= and metres, such as x=12.5", text);
    const int axis = (int)(letter - axes);
    if (!(at >= 0 && at <= job->domain.size_m[axis]))
        return fail(E_USAGE, "--cut %.40s: must be within the domain, whose %c is 0 to %g m", text, *letter,
                    job->domain.size_m[axis]);
    *out = (struct field_cut){axis == 2 || camera->eye[axis] > at ? CUT_LOW : CUT_HIGH, axis, at};
    return OK;
}

static status picture(struct look *l, const struct sketch *s, const struct look_options *o, struct model *m,
                      struct look_made *made)
{
    status st = OK;
    struct frame frame = {0};
    struct shot shot = {0};
    struct slate slate = {0};
    struct field_cut cut = {0};
    char right[32];
    const struct camera camera = camera_of(s->camera, s->frame);
    struct show_range range = show_job_range(o->sketch.show, s->job);
    if (o->range)
        TRY(show_parse_range(o->sketch.show, o->range, &range));
    if (o->cut)
        TRY(parse_cut(s->job, &camera, o->cut, &cut));
    TRY(model_pictures(m, &cut, &frame));
    made->years = frame.years;
    TRY(shot_make(s->job, s->frame, &frame.image[0], &camera, o->sketch.show, range, &shot));
    if (o->figure)
        figure_draw(s->job, s->frame, &shot);
    gizmos_draw(s->job, s->frame, o->gizmos, s->camera, &cut, &shot, &made->gizmos);
    slate.width = camera.width;
    slate.height = camera.height;
    snprintf(right, sizeof right, "at %.3g m", s->job->domain.spacing_m);
    slate_describe(s->job, s->frame, frame.years, &camera, o->sketch.show, range, o->no_slate ? NULL : right,
                   &slate);
    if (o->no_legend)
        slate = (struct slate){0};
    TRY(print_picture(&shot, &slate, o->folder, &made->png, &made->png_size));
    made->range = range;
    frame_free(&l->last);
    l->last = frame;
    frame = (struct frame){0};
done:
    shot_free(&shot);
    frame_free(&frame);
    return st;
}

void look_at(const struct look *l, double x, double y, struct text *json)
{
    const struct aov_image *image = l->last.n_images ? &l->last.image[0] : NULL;
    if (!image)
        return;
    const size_t px = (size_t)fmin(fmax(x * image->width, 0), image->width - 1),
                 py = (size_t)fmin(fmax(y * image->height, 0), image->height - 1),
                 i = py * (size_t)image->width + px;
    bool rock = false;
    for (size_t c = 0; c < image->n_channels; c++)
        rock |= strcmp(image->channel[c].name, "Z") == 0 && image->channel[c].value[i] < 1e9F;
    json_bool(json, "rock", rock);
    for (size_t c = 0; rock && c < image->n_channels; c++) {
        const struct aov_channel *channel = &image->channel[c];
        if (channel->value && strcmp(channel->part, "rgba") != 0)
            json_number(json, channel->name, (double)channel->value[i]);
        else if (channel->id)
            json_integer(json, channel->name, channel->id[i]);
    }
}

/* Takes over the numbers that the latest cached state of n frames carries, if they are not known. */
static status find_numbers(struct look *l, const uint64_t *hash, size_t n)
{
    status st = OK;
    struct checkpoint c = {0};
    while (n > 0 && !states_has(&l->states, hash[n - 1]))
        n--;
    if (n == 0 || history_has(&l->history, hash[n - 1]))
        return OK;
    if (states_find(&l->states, hash, n, &c) < n)
        TRY(history_take(&l->history, &c));
done:
    checkpoint_free(&c);
    return st;
}

status look_curves(struct look *l, struct text *json)
{
    status st = OK;
    struct job *job = l->shown.job;
    uint64_t *hash = NULL;
    if (!job)
        return OK;
    const size_t n = range_count(job->frames);
    TRY(memory_alloc(n, sizeof *hash, "hashes of frames", &hash));
    TRY(job_frame_hashes(job, job->frames.last, hash));
    TRY(find_numbers(l, hash, n));
    TRY(history_curves(&l->history, job, hash, l->shown.frame, json));
done:
    free(hash);
    return st;
}

status look_make(struct look *l, const struct look_options *o, struct look_made *made)
{
    status st = OK;
    const double began = clock_seconds();
    struct sketch s = {0};
    struct model *m = NULL;
    *made = (struct look_made){0};
    TRY(sketch_load(&o->sketch, &s));
    TRY(sketch_loses(&s, &made->coarse));
    const double loaded = clock_seconds();
    TRY(simulate_to_frame(l, &s, o, made, &m));
    const double there = clock_seconds();
    TRY(picture(l, &s, o, m, made));
    snprintf(made->name, sizeof made->name, "%s", s.job->name);
    made->frame = s.frame;
    made->spacing_m = s.job->domain.spacing_m;
    made->own_spacing_m = s.own_spacing_m;
    made->own_estimate = s.own_estimate;
    made->own_seconds = s.own_seconds;
    made->air_m = s.job->wind.flow.solver == FLOW_SPH ? s.job->wind.flow.spacing_m : 0;
    made->load_seconds = loaded - began;
    made->step_seconds = there - loaded;
    made->picture_seconds = clock_seconds() - there;
done:
    if (st != OK)
        look_made_free(made);
    model_destroy(&m);
    if (st == OK) {
        sketch_free(&l->shown);
        l->shown = s;
    } else {
        sketch_free(&s);
    }
    return st;
}
