#include "stacks/operations.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "stacks/intervals.h"
#include "stacks/path.h"
#include "stacks/tools.h"

bool operation_active(const struct job_operation *op, int frame)
{
    return range_holds(op->frames, frame);
}

/* The part of its path, from..to in 0..1, that a tool covers in this frame. */
static void progress(const struct job_operation *op, int frame, double *from, double *to)
{
    double n = (double)range_count(op->frames), k = (double)(frame - op->frames.first) / op->frames.step;
    *from = op->travel ? k / n : 0;
    *to = op->travel ? (k + 1) / n : 1;
}

static uint32_t solids(const struct tools *t)
{
    uint32_t set = 0;
    for (int m = MATERIAL_BEDROCK; m < t->n_materials; m++)
        if (m != MATERIAL_WATER && t->table[m].repose_deg >= 90)
            set |= 1u << m;
    return set;
}

static status find_material(const struct work *w, const char *name, uint32_t preset, uint32_t *out)
{
    *out = preset;
    if (!*name)
        return OK;
    for (int m = MATERIAL_BEDROCK; m < w->tools->n_materials; m++)
        if (strcmp(w->tools->table[m].name, name) == 0) {
            *out = (uint32_t)m;
            return OK;
        }
    return fail(
        E_USAGE,
        "%s.material: unknown material '%.64s': use bedrock, sand, rock, water or one of arches.materials",
        w->name, name);
}

/* ---- tools that change the field: bedrock becomes {f~ > 0} */

struct field_edit {
    const struct work *w;
    const struct path *path; /* or NULL: everywhere, or a sphere */
    double center[3], radius, strength;
    bool carve, noisy;
    double at[2]; /* m, the axis of the stack being edited */
    int i, j;
    const struct profile *line;
};

static double changed_field(void *user, double z, double *skip)
{
    (void)skip;
    const struct field_edit *e = user;
    const double x[3] = {e->at[0], e->at[1], z};
    double g = e->strength, f = profile_at(e->line, z);
    if (!e->noisy) {
        double d = 0;
        for (int a = 0; a < 3; a++)
            d += (x[a] - e->center[a]) * (x[a] - e->center[a]);
        double r = 1 - d / (e->radius * e->radius);
        return f + (r > 0 ? (e->carve ? -g : g) * r * r : 0);
    }
    if (e->path) {
        double radius = 1, d = path_distance(e->path, e->i, e->j, x, &radius);
        double r = fmin(fmax(-d / radius, 0), 1);
        g *= r * (2 - r);
    }
    if (g > 0)
        g *= e->w->tools->noise(e->w->tools->user, e->w->op->scale_m, e->w->op->flatten, x);
    return f + fmin(fmax(g, -0.98), 0.98);
}

/* Within lo..hi: bedrock in the intervals `in`; outside of them solid material becomes air. */
static status apply_field(const struct work *w, double lo, double hi, const struct intervals *in,
                          struct column *c)
{
    status st = OK;
    uint32_t from = stacks_quanta(w->stacks, lo), end = stacks_quanta(w->stacks, hi);
    /* Thinner changes are rounding, where f = 0 meets the layers. */
    uint32_t thin = (uint32_t)fmax(1, 0.02 * w->stacks->cell / w->stacks->quantum);
    for (size_t k = 0; k <= in->n; k++) {
        uint32_t a = k < in->n ? stacks_quanta(w->stacks, in->at[k].lo) : end;
        uint32_t b = k < in->n ? stacks_quanta(w->stacks, in->at[k].hi) : end;
        if (a > from + (k ? thin : 0))
            TRY(column_replace(c, from, a, w->solids, MATERIAL_AIR));
        if (b > a)
            TRY(column_replace(c, a, b, ~w->solids, MATERIAL_BEDROCK));
        from = b;
    }
done:
    return st;
}

static status edit_field(void *user, int i, int j, struct column *c)
{
    status st = OK;
    struct field_edit e = *(const struct field_edit *)user;
    const struct work *w = e.w;
    struct profile line = {0};
    struct intervals in = {0};
    double lo = 0, hi = STACK_TOP * w->stacks->quantum;
    e.i = i;
    e.j = j;
    e.at[0] = (i + 0.5) * w->stacks->cell;
    e.at[1] = (j + 0.5) * w->stacks->cell;
    if (!e.noisy) {
        double x = e.at[0] - e.center[0], y = e.at[1] - e.center[1];
        double square = e.radius * e.radius - x * x - y * y;
        if (!(square > 0))
            return OK;
        lo = fmax(lo, e.center[2] - sqrt(square));
        hi = fmin(hi, e.center[2] + sqrt(square));
    } else if (e.path) {
        double from, to;
        if (!path_heights(e.path, i, j, e.at, &from, &to))
            return OK;
        lo = fmax(lo, from);
        hi = fmin(hi, to);
    }
    if (!(hi > lo))
        return OK;
    TRY(surface_profile(&w->surface, e.at[0], e.at[1], &line));
    e.line = &line;
    /* |noise term| < 1, so it cannot change the sign where f is 1 or -1: `pinned`. */
    TRY(intervals_find(lo, hi, fmin(w->stacks->cell, w->tools->sigma) / 4, &line, e.noisy, changed_field, &e,
                       &in));
    TRY(apply_field(w, lo, hi, &in, c));
done:
    profile_free(&line);
    free(in.at);
    return st;
}

static status sculpt(struct work *w, double from, double to)
{
    status st = OK;
    const struct job_operation *op = w->op;
    for (size_t p = 0; p < op->n_points_m; p++) {
        double share = op->n_points_m > 1 ? (double)p / (double)(op->n_points_m - 1) : from;
        const double *at = op->points_m[p];
        struct field_edit e = {
            .w = w, .radius = at[3], .strength = op->strength, .carve = op->mode == MODE_CARVE};
        double v[3] = {at[0], at[1], at[2]}, normal[3];
        bool found = true;
        int lo[2], hi[2];
        if (share < from || (share >= to && to < 1))
            continue;
        if (op->project)
            TRY(surface_project(&w->surface, v, &found));
        if (!found)
            continue;
        surface_normal(&w->surface, v, normal);
        for (int a = 0; a < 3; a++)
            e.center[a] = v[a] + (e.carve ? 1 : -1) * op->delta * at[3] * normal[a];
        for (int a = 0; a < 2; a++) {
            lo[a] = (int)fmin(fmax(floor((e.center[a] - at[3]) / w->stacks->cell), 0), w->stacks->n[a]);
            hi[a] = (int)fmin(fmax(floor((e.center[a] + at[3]) / w->stacks->cell), -1), w->stacks->n[a] - 1);
        }
        TRY(work_edit(w, lo, hi, edit_field, &e));
    }
done:
    return st;
}

static status roughen(struct work *w, double from, double to)
{
    status st = OK;
    struct path path = {0};
    struct field_edit e = {.w = w, .strength = w->op->strength, .noisy = true};
    int lo[2] = {0, 0}, hi[2] = {w->stacks->n[0] - 1, w->stacks->n[1] - 1};
    if (w->op->n_points_m) {
        TRY(path_create(w->op, w->op->project ? &w->surface : NULL, w->stacks, from, to, 0, &path));
        e.path = &path;
        path_bounds(&path, lo, hi);
    }
    TRY(work_edit(w, lo, hi, edit_field, &e));
done:
    path_destroy(&path);
    return st;
}

/* ---- volumes: what a path sweeps */

struct volume_edit {
    const struct work *w;
    const struct path *path;
    uint32_t material, sand, rock;
    double at[2];
    int i, j;
    const struct profile *line; /* erode near the surface: f */
};

/* Positive inside the tool. */
static double inside(void *user, double z, double *skip)
{
    const struct volume_edit *e = user;
    const struct job_operation *op = e->w->op;
    const double x[3] = {e->at[0], e->at[1], z};
    double radius = 1, d = path_distance(e->path, e->i, e->j, x, &radius);
    /* Noise is cut off at 2.5 standard deviations and need not be evaluated farther out than that. The distance changes by at most about
     * 1 per metre, slightly more where the path bends. */
    if (d > 0 || !e->line)
        *skip = 0.8 * fmax(fabs(d) - 2.5 * op->roughness * radius, 0);
    if (op->roughness > 0 && fabs(d) < 2.5 * op->roughness * radius)
        d += op->roughness * radius *
             fmin(fmax(e->w->tools->noise(e->w->tools->user, op->scale_m, op->flatten, x), -2.5), 2.5);
    if (!e->line)
        return -d;
    /* Erosion near the surface: the depth decreases with the distance from the tool's axis. */
    double weight = fmin(fmax(-d / radius, 0), 1);
    return fmin(op->strength, 1.999) * weight * (2 - weight) - fmax(profile_at(e->line, z), 0);
}

/* Breaks up the solid layers in a..b: the lower part becomes sand, the upper part rocks. */
static status break_up(const struct volume_edit *e, uint32_t a, uint32_t b, struct column *c)
{
    status st = OK;
    const struct work *w = e->w;
    uint32_t from = a;
    while (from < b) {
        uint32_t to = b, material = column_at(c->layer, c->n, from);
        for (size_t k = 0; k < c->n; k++)
            if (layer_top(c->layer[k]) > from) {
                to = layer_top(c->layer[k]) < b ? layer_top(c->layer[k]) : b;
                break;
            }
        if (w->solids >> material & 1) {
            /* A less erodible material only loses the upper share of the layer. */
            double share = fmin(w->tools->table[material].erodibility, 1);
            uint32_t low = to - (uint32_t)(share * (to - from));
            uint32_t middle = low + (uint32_t)((1 - w->op->rocks) * (to - low));
            TRY(column_replace(c, low, middle, w->solids, e->sand));
            TRY(column_replace(c, middle, to, w->solids, e->rock));
        }
        from = to;
    }
done:
    return st;
}

static status edit_volume(void *user, int i, int j, struct column *c)
{
    status st = OK;
    struct volume_edit e = *(const struct volume_edit *)user;
    const struct work *w = e.w;
    const struct job_operation *op = w->op;
    struct profile line = {0};
    struct intervals in = {0};
    double lo, hi;
    e.i = i;
    e.j = j;
    e.at[0] = (i + 0.5) * w->stacks->cell;
    e.at[1] = (j + 0.5) * w->stacks->cell;
    if (!path_heights(e.path, i, j, e.at, &lo, &hi))
        return OK;
    lo = fmax(lo, 0);
    hi = fmin(hi, STACK_TOP * w->stacks->quantum);
    if (op->tool == TOOL_ERODE && op->depth == DEPTH_SURFACE) {
        TRY(surface_profile(&w->surface, e.at[0], e.at[1], &line));
        e.line = &line;
    }
    /* Pinned: a tool with strength < 1 does not reach rock where f = 1. */
    TRY(intervals_find(lo, hi, w->stacks->cell / 3, e.line, op->strength < 1, inside, &e, &in));
    for (size_t k = 0; k < in.n; k++) {
        uint32_t a = stacks_quanta(w->stacks, in.at[k].lo), b = stacks_quanta(w->stacks, in.at[k].hi);
        if (op->tool == TOOL_ERODE)
            TRY(break_up(&e, a, b, c));
        else if (op->mode == MODE_CARVE)
            TRY(column_set(c, a, b, MATERIAL_AIR));
        else
            TRY(column_replace(c, a, b, 1u << MATERIAL_AIR | 1u << MATERIAL_WATER, e.material));
    }
done:
    profile_free(&line);
    free(in.at);
    return st;
}

static status sweep(struct work *w, double from, double to)
{
    status st = OK;
    struct path path = {0};
    struct volume_edit e = {.w = w, .path = &path, .sand = MATERIAL_SAND, .rock = MATERIAL_ROCK};
    int lo[2], hi[2];
    TRY(find_material(w, w->op->material, MATERIAL_BEDROCK, &e.material));
    TRY(path_create(w->op, w->op->project ? &w->surface : NULL, w->stacks, from, to, 2.5 * w->op->roughness,
                    &path));
    path_bounds(&path, lo, hi);
    TRY(work_edit(w, lo, hi, edit_volume, &e));
done:
    path_destroy(&path);
    return st;
}

/* ---- deposit */

struct drop {
    const struct work *w;
    const struct path *path;
    uint32_t material;
    double thickness;
};

static status edit_drop(void *user, int i, int j, struct column *c)
{
    const struct drop *d = user;
    const struct stacks *s = d->w->stacks;
    const double at[2] = {(i + 0.5) * s->cell, (j + 0.5) * s->cell};
    double lo, hi, radius = 1, best = 0, from = 0;
    if (!path_heights(d->path, i, j, at, &lo, &hi))
        return OK;
    /* The brush profile (1 - (d / R)^2)^2, with d the horizontal distance to the nearest point of the path. */
    for (size_t k = 0; k < d->path->n; k++) {
        const struct path_end *a = &d->path->segment[k].end[0], *b = &d->path->segment[k].end[1];
        double bx = b->at[0] - a->at[0], by = b->at[1] - a->at[1];
        double x = at[0] - a->at[0], y = at[1] - a->at[1];
        double square = bx * bx + by * by, t = square > 0 ? fmin(fmax((x * bx + y * by) / square, 0), 1) : 0;
        radius = a->radius + t * (b->radius - a->radius);
        double r = 1 - ((x - t * bx) * (x - t * bx) + (y - t * by) * (y - t * by)) / (radius * radius);
        if (r > 0 && r * r > best) {
            best = r * r;
            from = a->at[2] + t * (b->at[2] - a->at[2]);
        }
    }
    uint32_t amount = stacks_quanta(s, d->thickness * best), z = stacks_quanta(s, from), bottom = 0,
             space = 0;
    if (amount == 0)
        return OK;
    /* Drop it on the first ground below the tool, or, if the tool is inside of something, into the first space above it. */
    uint32_t ground = 0;
    for (size_t k = 0; k <= c->n; k++) {
        uint32_t top = k < c->n ? layer_top(c->layer[k]) : (uint32_t)STACK_TOP;
        uint32_t m = k < c->n ? layer_material(c->layer[k]) : (uint32_t)MATERIAL_AIR;
        if (m == MATERIAL_AIR || m == MATERIAL_WATER) {
            bool below = k && (layer_material(c->layer[k - 1]) == MATERIAL_WATER ||
                               layer_material(c->layer[k - 1]) == MATERIAL_AIR);
            ground = below ? ground : bottom;
            space = top - ground;
            if (top > z)
                break;
        }
        bottom = top;
    }
    return column_set(c, ground, ground + (amount < space ? amount : space), d->material);
}

static status deposit(struct work *w, double from, double to)
{
    status st = OK;
    struct path path = {0};
    struct drop d = {.w = w, .path = &path, .thickness = w->op->thickness_m};
    int lo[2], hi[2];
    if (!w->op->travel)
        d.thickness /= (double)range_count(w->op->frames);
    TRY(find_material(w, w->op->material, MATERIAL_SAND, &d.material));
    TRY(path_create(w->op, NULL, w->stacks, from, to, 0, &path));
    path_bounds(&path, lo, hi);
    TRY(work_edit(w, lo, hi, edit_drop, &d));
done:
    path_destroy(&path);
    return st;
}

/* ---- dispatch */

status work_edit(struct work *w, const int lo[2], const int hi[2], column_edit edit, void *user)
{
    for (int a = 0; a < 2; a++) {
        w->lo[a] = lo[a] < w->lo[a] ? lo[a] : w->lo[a];
        w->hi[a] = hi[a] > w->hi[a] ? hi[a] : w->hi[a];
    }
    return stacks_edit(w->stacks, lo, hi, edit, user);
}

status operation_apply(struct stacks *s, const struct tools *tools, const struct job_operation *op,
                       const char *path, int frame, int lo[2], int hi[2])
{
    status st = OK;
    struct stacks edited = {0};
    double from, to;
    struct work w = {.stacks = &edited,
                     .tools = tools,
                     .op = op,
                     .name = path,
                     .solids = solids(tools),
                     .lo = {INT32_MAX, INT32_MAX},
                     .hi = {-1, -1}};
    TRY(stacks_copy(s, &edited));
    w.surface = (struct surface){&edited, w.solids, tools->sigma};
    progress(op, frame, &from, &to);
    switch (op->tool) {
    case TOOL_SCULPT:
        TRY(sculpt(&w, from, to));
        break;
    case TOOL_SWEEP:
    case TOOL_ERODE:
        TRY(sweep(&w, from, to));
        break;
    case TOOL_DEPOSIT:
        TRY(deposit(&w, from, to));
        break;
    case TOOL_FILL:
        TRY(fill_water(&w));
        break;
    case TOOL_NOISE:
        TRY(roughen(&w, from, to));
        break;
    }
    for (int a = 0; a < 2; a++) {
        lo[a] = w.lo[a];
        hi[a] = w.hi[a];
    }
    stacks_destroy(s);
    *s = edited;
    edited = (struct stacks){0};
done:
    stacks_destroy(&edited);
    return st;
}
