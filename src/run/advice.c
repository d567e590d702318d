#include "run/advice.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/log.h"
#include "base/memory.h"
#include "field/camera.h"
#include "groundwater/contacts.h"
#include "job/table.h"
#include "scene/scene.h"
#include "shared/params.h"

/* What the checks work on. */
struct context {
    const struct job *job;
    struct advice_list *out;
    struct scene_survey survey;
    double low[3], high[3]; /* m: bounds of the rock in the domain */
    double kyr;             /* from the first frame to the last; 0 in a shot */
    bool log_inputs;        /* log what reading files reports, and their volumes */
    bool run_follows;       /* which logs the volumes itself */
};

static status add_advice(struct context *v, const char *key, const char *format, ...) PRINTF_LIKE(3, 4);
static status add_advice(struct context *v, const char *key, const char *format, ...)
{
    struct advice_list *a = v->out;
    const status st = memory_grow(&a->item, &a->capacity, a->n + 1, sizeof *a->item, "advice");
    if (st != OK)
        return st;
    struct advice *one = &a->item[a->n++];
    va_list arguments;
    va_start(arguments, format);
    snprintf(one->key, sizeof one->key, "%s", key);
    vsnprintf(one->text, sizeof one->text, format, arguments);
    va_end(arguments);
    return OK;
}

/* ---- the rock in its domain */

static bool is_wall(const struct job *job, int axis, int high)
{
    static const unsigned side[2][2] = {{WALL_X_MIN, WALL_X_MAX}, {WALL_Y_MIN, WALL_Y_MAX}};
    return axis < 2 && (job_walls(job) & side[axis][high]) != 0;
}

/* Whether x is outside of the domain beyond the top or a side without a wall. Rock below the ground is cut off on purpose. */
static bool cut_off(const struct job *job, const double x[3])
{
    for (int a = 0; a < 3; a++)
        if ((x[a] < 0 && a < 2 && !is_wall(job, a, 0)) ||
            (x[a] > job->domain.size_m[a] && !is_wall(job, a, 1)))
            return true;
    return false;
}

/* Estimates the share of the scene that is cut off, from the points of a lattice over its bounding box. */
static status check_domain(struct context *v)
{
    enum { ACROSS = 32 };
    double low[3], high[3], x[3];
    size_t all = 0, outside = 0;
    if (!v->survey.solid)
        return OK;
    solid_bounds(v->survey.solid, low, high);
    for (int a = 0; a < 3; a++) {
        const double size = v->job->domain.size_m[a];
        low[a] = fmax(low[a], -10 * size);
        high[a] = fmin(high[a], 11 * size);
        if (!(low[a] < high[a]))
            return OK;
    }
    for (size_t i = 0; i < (size_t)ACROSS * ACROSS * ACROSS; i++) {
        const size_t at[3] = {i % ACROSS, i / ACROSS % ACROSS, i / ACROSS / ACROSS};
        for (int a = 0; a < 3; a++)
            x[a] = low[a] + ((double)at[a] + 0.5) / ACROSS * (high[a] - low[a]);
        if (x[2] < 0 || solid_at(v->survey.solid, x).distance > 0)
            continue;
        all++;
        outside += cut_off(v->job, x);
    }
    if (outside * 10 <= all)
        return OK;
    return add_advice(
        v, "domain.size_m",
        "about %.0f %% of the scene is outside the domain and is cut off: the scene reaches from (%.4g, %.4g) to (%.4g, %.4g, %.4g) m, the domain from 0 to (%.4g, %.4g, %.4g)",
        100 * (double)outside / (double)all, low[0], low[1], high[0], high[1], high[2],
        v->job->domain.size_m[0], v->job->domain.size_m[1], v->job->domain.size_m[2]);
}

/* ---- input files */

/* Compares the volume of each input file, of its own geometry, with that of the rock sampled from it. If the two differ, the simulated rock
 * is not what the author of the file saw. */
static status check_inputs(struct context *v)
{
    status st = OK;
    char text[600];
    for (size_t i = 0; i < v->survey.n_inputs && !v->run_follows; i++)
        if (scene_input_text(&v->survey.input[i], v->job->domain.spacing_m, text))
            TRY(add_advice(v, "scene", "%s", text));
        else if (v->log_inputs)
            log_info("%s", text);
done:
    return st;
}

/* ---- features smaller than the spacing */

static status check_node(struct context *v, const struct job_node *node)
{
    status st = OK;
    const double h = v->job->domain.spacing_m;
    if (node->kind == NODE_SHAPE && node->shape == SHAPE_BOX) {
        const struct job_box *b = &node->u.box;
        for (int a = 0; a < 3; a++)
            if ((b->max_m[a] - b->min_m[a]) * b->scale[a] < h)
                return add_advice(
                    v, "scene",
                    "a%s box of the scene is %.3g m thick, less than domain.spacing_m (%g): how much of it is sampled depends on the spacing",
                    b->inert ? "n inert" : "", (b->max_m[a] - b->min_m[a]) * b->scale[a], h);
    }
    for (size_t i = 0; i < node->n_child; i++)
        TRY(check_node(v, node->child[i]));
done:
    return st;
}

static status check_sizes(struct context *v)
{
    status st = OK;
    const struct job *job = v->job;
    const double h = job->domain.spacing_m;
    char key[64];
    double below = -INFINITY;
    if (job->scene)
        TRY(check_node(v, job->scene));
    for (size_t i = 0; i < job->n_strata; i++) {
        const double top = job->strata[i].to_m, thick = top - below;
        snprintf(key, sizeof key, "strata.%zu.to_m", i);
        if (thick < h && top > v->low[2] && below < v->high[2])
            TRY(add_advice(
                v, key,
                "the layer is %.3g m thick, less than domain.spacing_m (%g): whether it gets any particles is a matter of chance",
                thick, h));
        below = top;
    }
    if (job->skin.damp > 1 && job->skin.damp_m < 2 * h)
        TRY(add_advice(
            v, "skin.damp_m",
            "damp reaches %g m, less than two spacings (%g m): the width of holes depends on the spacing, and with 0 there are none",
            job->skin.damp_m, 2 * h));
    if (job->groundwater.recharge_m_per_yr > 0 && contacts_beds(job) == 0)
        TRY(add_advice(
            v, "groundwater",
            "no stratum has a conductivity_m_per_yr below recharge_m_per_yr (%g), so no bed holds water back and nothing seeps out",
            job->groundwater.recharge_m_per_yr));
    if (job->noise.amplitude > 0 && job->noise.scale_m < 2 * h)
        TRY(add_advice(
            v, "noise.scale_m",
            "features of %g m are finer than two spacings (%g m): the rock changes with the spacing",
            job->noise.scale_m, 2 * h));
done:
    return st;
}

static status check_structure(struct context *v)
{
    status st = OK;
    const struct job *job = v->job;
    const double h = job->domain.spacing_m;
    char key[64];
    for (size_t i = 0; i < job->n_strata_from; i++) {
        const struct job_bedding *b = &job->strata_from[i];
        snprintf(key, sizeof key, "strata_from.%zu.thickness_m", i);
        if (!b->n_column && b->thickness_m < h)
            TRY(add_advice(
                v, key,
                "beds are %.3g m thick on average, less than domain.spacing_m (%g): they act together, and single beds do not show",
                b->thickness_m, h));
        snprintf(key, sizeof key, "strata_from.%zu.cross.lamina_m", i);
        if (b->cross.set_m > 0 && b->cross.lamina_m < h)
            TRY(add_advice(
                v, key,
                "laminae are %.3g m thick, less than domain.spacing_m (%g): hardly anything of them shows",
                b->cross.lamina_m, h));
    }
    for (size_t i = 0; i < job->n_concretions; i++) {
        snprintf(key, sizeof key, "concretions.%zu.radius_m", i);
        const struct job_concretion *c = &job->concretions[i];
        if (c->radius_m * fmin(1, 1 / c->flatten) < h)
            TRY(add_advice(
                v, key,
                "concretions are %.3g m in radius, %.3g m across the beds, less than domain.spacing_m (%g): they hardly show",
                c->radius_m, c->radius_m / c->flatten, h));
    }
    for (size_t i = 0; i < job->n_joints; i++) {
        snprintf(key, sizeof key, "joints.%zu.spacing_m", i);
        if (job->joints[i].spacing_m < 2 * h)
            TRY(add_advice(
                v, key,
                "joints are %.3g m apart, closer than two spacings (%g m): the rock between them is too thin to show",
                job->joints[i].spacing_m, 2 * h));
    }
done:
    return st;
}

/* ---- stress and rates */

/* The foot of a column carries density * gravity * height. Arches and pillars form if the interlocking stress is within a factor of
 * a few of that, so that grains interlock in some places and not in others (Arenite 8). Advice is given only if no layer comes that
 * close; it names the closest one. */
static status check_interlocking(struct context *v)
{
    enum { FAR = 5 };
    const struct job *job = v->job;
    const double weight_of_metre = 1e-6 * job->rock.density_kg_m3 * job->rock.gravity_m_s2; /* MPa */
    double below = -INFINITY, nearest = INFINITY, most = 0, height = 0;
    const double preset = table_find(SECTION_layer, "interlock_MPa")->number;
    size_t which = 0;
    bool typed = false; /* the job sets interlock_MPa; there is no advice about a default */
    char key[64];
    if (!job_model(job)->interlocks || !(weight_of_metre > 0))
        return OK;
    for (size_t i = 0; i < job->n_strata; i++) {
        const struct job_layer *l = &job->strata[i];
        const double bottom = fmax(below, v->low[2]), above = v->high[2] - bottom;
        below = l->to_m;
        if (bottom >= fmin(l->to_m, v->high[2]) || above <= 0)
            continue;
        typed |= l->interlock_MPa.n > 1 || l->interlock_MPa.value[0] != preset;
        const double least = curve_min(&l->interlock_MPa) * curve_min(&job->strata_scale.interlock) /
                             (weight_of_metre * above);
        most = fmax(most, curve_max(&l->interlock_MPa) * curve_max(&job->strata_scale.interlock) /
                              (weight_of_metre * above));
        if (least < nearest) {
            nearest = least;
            which = i;
            height = above;
        }
    }
    snprintf(key, sizeof key, "strata.%zu.interlock_MPa", which);
    if (!typed)
        return OK;
    if (isfinite(nearest) && nearest > FAR)
        return add_advice(
            v, key,
            "interlocking needs the weight of at least %.3g m of rock, and no layer has nearly as much above its foot (this one %.3g m, which weighs %.3g MPa): no grains ever interlock, and stress has no effect",
            nearest * height, height, weight_of_metre * height);
    if (most > 0 && most < 1e-3)
        return add_advice(
            v, key,
            "all layers interlock at %.2g of the weight of the rock or less: all rock is interlocked from the start and weathers at strong_m_per_kyr",
            most);
    return OK;
}

static status check_time(struct context *v)
{
    const struct job *job = v->job;
    const double across = fmin(v->high[0] - v->low[0], v->high[1] - v->low[1]), h = job->domain.spacing_m;
    double most = 0;
    size_t which = 0;
    char key[64];
    if (v->kyr <= 0 || job_model(job)->terrain || !job->n_strata)
        return OK;
    for (size_t i = 0; i < job->n_strata; i++) {
        const double rate = curve_max(&job->strata[i].weak_m_per_kyr) * curve_max(&job->strata_scale.rates);
        which = rate > most ? i : which;
        most = fmax(most, rate);
    }
    snprintf(key, sizeof key, "strata.%zu.weak_m_per_kyr", which);
    if (most * v->kyr > 20 * across)
        return add_advice(
            v, key,
            "this layer retreats %.3g m in the job's %.4g kyr, and the rock is %.3g m across: little will be left long before the end",
            most * v->kyr, v->kyr, across);
    if (most * v->kyr < 0.1 * h && v->kyr > 0)
        return add_advice(
            v, key,
            "the softest layer retreats %.2g m in the job's %.4g kyr, a small part of domain.spacing_m (%g): hardly anything will change",
            most * v->kyr, v->kyr, h);
    return OK;
}

/* ---- cameras */

static bool sees(const struct camera *c, const struct scene_size *size)
{
    for (size_t i = 0; i < size->n_points; i++) {
        const double x[3] = {(double)size->point[i][0], (double)size->point[i][1], (double)size->point[i][2]};
        double px[2];
        if (camera_project(c, x, px) && px[0] >= 0 && px[0] < c->width && px[1] >= 0 && px[1] < c->height)
            return true;
    }
    return false;
}

static status check_cameras(struct context *v)
{
    status st = OK;
    const struct job *job = v->job;
    for (size_t i = 0; i < job->n_cameras; i++) {
        const int frame[] = {job->frames.first, (job->frames.first + job->frames.last) / 2, job->frames.last};
        char key[160];
        snprintf(key, sizeof key, "cameras.%.64s", job->cameras[i].name);
        for (int k = 0; k < 3; k++) {
            const struct camera c = camera_of(&job->cameras[i], frame[k]);
            const char *wrong = v->survey.solid && k == 0 && solid_at(v->survey.solid, c.eye).distance < 0
                                    ? "stands inside the rock"
                                : c.eye[2] < 0 ? "stands below the ground"
                                : v->survey.size.n_points && !sees(&c, &v->survey.size)
                                    ? "does not see the rock"
                                    : NULL;
            if (!wrong)
                continue;
            TRY(add_advice(v, key, "in frame %d it %s, from (%.4g, %.4g, %.4g) m", frame[k], wrong, c.eye[0],
                           c.eye[1], c.eye[2]));
            break;
        }
    }
done:
    return st;
}

/* ---- keys without effect */

static status check_model(struct context *v)
{
    static const struct {
        const char *section;
        unsigned models; /* that have it */
    } used[] = {
        {"wind", OF_MODEL(ARENITE)},
        {"rain", OF_MODEL(ARENITE)},
        {"sources", OF_MODEL(ARENITE)},
        {"deposition", OF_MODEL(ARENITE)},
        {"collapse", OF_MODEL(ARENITE)},
        {"vegetation", OF_MODEL(ARENITE)},
        {"erosion", OF_MODEL(ARENITE)},
        {"strata_from", OF_MODEL(ARENITE) | OF_MODEL(GOBLINS)},
        {"joints", OF_MODEL(ARENITE) | OF_MODEL(GOBLINS)},
        {"concretions", OF_MODEL(ARENITE) | OF_MODEL(GOBLINS)},
        {"skin", OF_MODEL(ARENITE)},
        {"aspect", OF_MODEL(ARENITE)},
        {"sheeting", OF_MODEL(ARENITE)},
        {"groundwater", OF_MODEL(ARENITE)},
        {"goblins", OF_MODEL(GOBLINS)},
        {"arches", OF_MODEL(ARCHES)},
    };
    status st = OK;
    for (size_t i = 0; i < sizeof used / sizeof *used; i++) {
        bool preset = true;
        if (used[i].models & (1U << v->job->model))
            continue;
        TRY(job_is_default(v->job, used[i].section, &preset));
        if (!preset)
            TRY(add_advice(v, used[i].section, "model: %s has no %s: these keys have no effect",
                           job_model(v->job)->name, used[i].section));
    }
done:
    return st;
}

static bool overlap(struct frame_range a, struct frame_range b)
{
    return a.first <= b.last && a.last >= b.first;
}

static status check_frames(struct context *v)
{
    status st = OK;
    const struct job *job = v->job;
    char key[64], range[48];
    for (size_t i = 0; i < job->n_edits; i++)
        if (job->edits[i].frame > job->frames.last || job->edits[i].frame < job->frames.first) {
            snprintf(key, sizeof key, "edits.%zu.frame", i);
            TRY(add_advice(v, key, "frame %d is not one of the frames (%s): this edit is never made",
                           (int)job->edits[i].frame, range_text(job->frames, range)));
        }
    for (size_t i = 0; i < job->wind.n_gusts; i++)
        if (!overlap(job->wind.gusts[i].frames, job->frames)) {
            snprintf(key, sizeof key, "wind.gusts.%zu.frames", i);
            TRY(add_advice(v, key, "none of the job's frames (%s) are in this range",
                           range_text(job->frames, range)));
        }
    for (size_t i = 0; i < job->arches.n_operations; i++)
        if (!overlap(job->arches.operations[i].frames, job->frames)) {
            snprintf(key, sizeof key, "arches.operations.%zu.frames", i);
            TRY(add_advice(v, key, "none of the job's frames (%s) are in this range: the tool is never used",
                           range_text(job->frames, range)));
        }
done:
    return st;
}

/* Tools and sources whose path is outside of the domain. */
static status check_paths(struct context *v)
{
    status st = OK;
    const struct job *job = v->job;
    char key[64];
    for (size_t i = 0; i < job->arches.n_operations; i++) {
        const struct job_operation *o = &job->arches.operations[i];
        bool near = o->n_points_m == 0;
        for (size_t p = 0; p < o->n_points_m && !near; p++) {
            near = true;
            for (int a = 0; a < 3; a++)
                near &= o->points_m[p][a] > -o->points_m[p][3] &&
                        o->points_m[p][a] < job->domain.size_m[a] + o->points_m[p][3];
        }
        snprintf(key, sizeof key, "arches.operations.%zu.points_m", i);
        if (!near && o->n_points_m < 2)
            TRY(add_advice(v, key, "the tool is outside the domain: it has no effect"));
    }
    for (size_t i = 0; i < job->n_sources; i++) {
        const struct job_source *s = &job->sources[i];
        bool inside = false;
        for (size_t p = 0; p < s->n_path_m; p++)
            inside |= s->path_m[p][0] >= 0 && s->path_m[p][0] <= job->domain.size_m[0] &&
                      s->path_m[p][1] >= 0 && s->path_m[p][1] <= job->domain.size_m[1];
        snprintf(key, sizeof key, "sources.%zu.path_m", i);
        if (!inside)
            TRY(add_advice(v, key, "no point of this path is in the domain"));
    }
done:
    return st;
}

/* ---- all */

static status collect(const struct job *job, bool log_inputs, bool run_follows, struct advice_list *out)
{
    static status (*const checks[])(struct context * v) = {
        check_domain, check_inputs, check_sizes,   check_structure, check_interlocking,
        check_time,   check_model,  check_cameras, check_frames,    check_paths};
    status st = OK;
    struct context v = {.job = job, .out = out, .log_inputs = log_inputs, .run_follows = run_follows};
    const bool before = log_silence(!log_inputs);
    v.kyr = job->clock.seconds_per_frame > 0 ? 0 : 1e-3 * job_years(job, job->frames.first, job->frames.last);
    TRY(scene_survey(job, &v.survey));
    if (!job_model(job)->terrain)
        TRY(scene_check(job, job->goblins.floats, &v.survey));
    if (log_inputs)
        TRY(scene_paint_check(job));
    scene_bounds(&v.survey.size, v.low, v.high);
    for (size_t i = 0; i < sizeof checks / sizeof *checks; i++)
        if (v.survey.size.n_points > 0 || checks[i] == check_domain)
            TRY(checks[i](&v));
done:
    log_silence(before);
    scene_survey_free(&v.survey);
    return st;
}

status advice_collect(const struct job *job, bool log_inputs, struct advice_list *out)
{
    return collect(job, log_inputs, false, out);
}

void advice_free(struct advice_list *a)
{
    free(a->item);
    *a = (struct advice_list){0};
}

status advice_log(const struct job *job, bool run_follows)
{
    enum { QUICK = 4 << 20, MOST = 12 };
    status st = OK;
    struct advice_list a = {0};
    struct job_input *input = NULL;
    size_t n = 0;
    uint64_t bytes = 0;
    TRY(job_inputs(job, &input, &n));
    for (size_t i = 0; i < n; i++)
        bytes += input[i].size;
    if (bytes > QUICK)
        goto done;
    TRY(collect(job, false, run_follows, &a));
    for (size_t i = 0; i < a.n && i < MOST; i++)
        log_warn("%s%s%s: %s", job->wedge.index ? job->name : "", job->wedge.index ? ": " : "", a.item[i].key,
                 a.item[i].text);
done:
    job_inputs_free(&input, n);
    advice_free(&a);
    return st == E_MEMORY ? st : OK;
}
