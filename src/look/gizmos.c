#include "look/gizmos.h"

#include <math.h>
#include <string.h>

#include "base/vector.h"
#include "job/table.h"
#include "shape/placement.h"
#include "wind/wind.h"

struct ink {
    const char *name;
    unsigned char rgb[3];
};
static const struct ink INK_DOMAIN = {"grey", {150, 158, 170}}, INK_WIND = {"cyan", {110, 225, 235}},
                        INK_WATER = {"blue", {60, 120, 255}}, INK_PAINT = {"magenta", {235, 90, 220}},
                        INK_CARVE = {"red", {255, 70, 60}}, INK_ADD = {"green", {90, 215, 90}},
                        INK_TOOL = {"orange", {255, 160, 30}}, INK_CAMERA = {"yellow", {250, 225, 70}},
                        INK_CUT = {"white", {240, 240, 240}};

/* The drawing state; coordinates are in the world, or local to a placement. */
struct drawing {
    struct shot *shot;
    const struct ink *ink;
    const struct placement *place;
    bool unseen; /* a part of the shape has no outline */
};

enum { ROUND = 40 };

static void line(const struct drawing *d, const double from[3], const double to[3])
{
    double a[3], b[3];
    memcpy(a, from, sizeof a);
    memcpy(b, to, sizeof b);
    if (d->place) {
        placement_apply(d->place->world_from_local, from, a);
        placement_apply(d->place->world_from_local, to, b);
    }
    shot_line(d->shot, a, b, d->ink->rgb);
}

static void box(const struct drawing *d, const double low[3], const double high[3])
{
    for (int corner = 0; corner < 8; corner++)
        for (int axis = 0; axis < 3; axis++) {
            double from[3], to[3];
            if (corner >> axis & 1)
                continue;
            for (int k = 0; k < 3; k++)
                from[k] = to[k] = corner >> k & 1 ? high[k] : low[k];
            to[axis] = high[axis];
            line(d, from, to);
        }
}

/* A circle around `middle` in the plane normal to the unit vector `normal`. */
static void ring(const struct drawing *d, const double middle[3], const double normal[3], double radius)
{
    const double aside[3] = {fabs(normal[2]) < 0.9 ? 0 : 1, 0, fabs(normal[2]) < 0.9 ? 1 : 0};
    double u[3], v[3], before[3] = {0};
    cross3(normal, aside, u);
    const double length = sqrt(dot3(u, u));
    for (int k = 0; k < 3; k++)
        u[k] /= length;
    cross3(normal, u, v);
    for (int i = 0; i <= ROUND; i++) {
        const double turn = 2 * 3.14159265358979323846 * i / ROUND;
        double now[3];
        for (int k = 0; k < 3; k++)
            now[k] = middle[k] + radius * (cos(turn) * u[k] + sin(turn) * v[k]);
        if (i)
            line(d, before, now);
        memcpy(before, now, sizeof before);
    }
}

static void ball(const struct drawing *d, const double middle[3], double radius)
{
    for (int axis = 0; axis < 3; axis++) {
        double normal[3] = {0};
        normal[axis] = 1;
        ring(d, middle, normal, radius);
    }
}

static bool unit_between(const double from[3], const double to[3], double out[3])
{
    minus3(to, from, out);
    const double length = sqrt(dot3(out, out));
    for (int k = 0; k < 3 && length > 0; k++)
        out[k] /= length;
    return length > 0;
}

static void arrow(const struct drawing *d, const double from[3], const double to[3])
{
    double along[3], side[3], over[3];
    const double up[3] = {0, 0, 1};
    if (!unit_between(from, to, along))
        return;
    line(d, from, to);
    cross3(along, up, side);
    if (dot3(side, side) < 1e-6) {
        side[0] = 1;
        side[1] = side[2] = 0;
    }
    double back[3];
    minus3(to, from, back);
    const double length = 0.2 * sqrt(dot3(back, back));
    cross3(along, side, over);
    for (int barb = 0; barb < 4; barb++) {
        const double *across = barb < 2 ? side : over;
        double end[3];
        for (int k = 0; k < 3; k++)
            end[k] = to[k] - length * along[k] + (barb & 1 ? -0.4 : 0.4) * length * across[k];
        line(d, to, end);
    }
}

/* A tube around a path of points with radii. */
static void path(const struct drawing *d, const double (*point)[3], size_t n, double radius)
{
    double along[3];
    for (size_t i = 0; i < n; i++) {
        if (i)
            line(d, point[i - 1], point[i]);
        if (radius > 0 && n > 1 && unit_between(point[i ? i - 1 : 0], point[i ? i : 1], along))
            ring(d, point[i], along, radius);
    }
    if (radius > 0 && n == 1)
        ball(d, point[0], radius);
}

static void cylinder(const struct drawing *d, const struct job_cylinder *c)
{
    double along[3];
    const double top = c->top_radius_m < 0 ? c->radius_m : c->top_radius_m;
    if (!unit_between(c->from_m, c->to_m, along))
        return;
    ring(d, c->from_m, along, c->radius_m);
    ring(d, c->to_m, along, top);
    line(d, c->from_m, c->to_m);
}

static void node(struct drawing *d, const struct placement *parent, const struct job_node *n)
{
    const struct placement place = placement_child(parent, n);
    const struct placement *before = d->place;
    d->place = &place;
    for (size_t i = 0; n->kind != NODE_SHAPE && i < n->n_child; i++)
        node(d, &place, n->child[i]);
    if (n->kind == NODE_SHAPE)
        switch (n->shape) {
        case SHAPE_BOX:
            box(d, n->u.box.min_m, n->u.box.max_m);
            break;
        case SHAPE_SPHERE:
            ball(d, n->u.sphere.center_m, n->u.sphere.radius_m);
            break;
        case SHAPE_CYLINDER:
            cylinder(d, &n->u.cylinder);
            break;
        case SHAPE_STROKE:
            path(d, (const double(*)[3])n->u.stroke.path_m, n->u.stroke.n_path_m, n->u.stroke.radius_m);
            break;
        case SHAPE_FUNCTION:
            box(d, n->u.function.min_m, n->u.function.max_m);
            break;
        default:
            d->unseen = true;
        }
    d->place = before;
}

/* ---- the parts of a job */

static void say(struct text *said, const struct ink *ink, const char *what, size_t index, const char *more)
{
    text_add(said, "%-8s %s", ink->name, what);
    if (index != SIZE_MAX)
        text_add(said, ".%zu", index);
    text_add(said, "%s%s\n", *more ? ": " : "", more);
}

static void shape(struct shot *s, const struct ink *ink, const struct job_node *shape, struct text *said,
                  const char *what, size_t index, const char *more)
{
    const struct placement world = placement_identity();
    struct drawing d = {.shot = s, .ink = ink};
    struct text words = {0};
    node(&d, &world, shape);
    text_add(&words, "%s%s", more, d.unseen ? " (without an outline)" : "");
    say(said, ink, what, index, words.data ? words.data : "");
    text_free(&words);
}

static void draw_wind(const struct job *job, int frame, struct shot *s, struct text *said)
{
    const struct wind_at w = wind_at(job, frame);
    const double *size = job->domain.size_m, span = fmax(fmax(size[0], size[1]), size[2]);
    struct drawing d = {.shot = s, .ink = &INK_WIND};
    struct text words = {0};
    double from[3], to[3];
    if (!job_model(job)->wind || w.speed <= 0)
        return;
    for (int k = 0; k < 3; k++) {
        const double middle = k == 2 ? 0.55 * size[2] : 0.5 * size[k];
        to[k] = middle - w.direction[k] * 0.55 * span;
        from[k] = to[k] - w.direction[k] * 0.22 * span;
    }
    arrow(&d, from, to);
    text_add(&words, "%.3g m/s", w.speed);
    say(said, &INK_WIND, "wind", SIZE_MAX, words.data ? words.data : "");
    text_free(&words);
}

static void draw_sources(const struct job *job, int frame, struct shot *s, struct text *said)
{
    for (size_t i = 0; i < job->n_sources; i++) {
        const struct job_source *source = &job->sources[i];
        struct drawing d = {.shot = s, .ink = &INK_WATER};
        struct text words = {0};
        double above[3];
        if (source->n_path_m == 0)
            continue;
        path(&d, (const double(*)[3])source->path_m, source->n_path_m, source->bed_m);
        memcpy(above, source->path_m[0], sizeof above);
        above[2] += 0.12 * job->domain.size_m[2];
        arrow(&d, above, source->path_m[0]);
        text_add(&words, "%.6g m3/yr", curve_at(&source->m3_per_yr, frame));
        say(said, &INK_WATER, "sources", i, words.data ? words.data : "");
        text_free(&words);
    }
}

static void draw_edits(const struct job *job, int frame, bool all, struct shot *s, struct text *said)
{
    for (size_t i = 0; i < job->n_edits; i++) {
        const struct job_edit *e = &job->edits[i];
        struct text words = {0};
        if (!all && e->frame != frame)
            continue;
        text_add(&words, "frame %lld", (long long)e->frame);
        const char *when = words.data ? words.data : "";
        if (e->carve)
            shape(s, &INK_CARVE, e->carve, said, "edits", i, when);
        for (size_t k = 0; k < e->n_add; k++)
            shape(s, &INK_ADD, e->add[k].shape, said, "edits", i, when);
        for (size_t k = 0; k < e->n_paint; k++)
            if (e->paint[k].shape)
                shape(s, &INK_PAINT, e->paint[k].shape, said, "edits", i, when);
        text_free(&words);
    }
    for (size_t i = 0; i < job->n_paint; i++)
        if (job->paint[i].shape)
            shape(s, &INK_PAINT, job->paint[i].shape, said, "paint", i, "");
}

static void draw_operation(const struct job_operation *o, struct drawing *d)
{
    for (size_t i = 0; i < o->n_points_m; i++)
        ball(d, o->points_m[i], o->points_m[i][3]);
    for (size_t i = 0; i < o->n_arcs; i++) {
        const size_t from = (size_t)o->arcs[i][0], to = (size_t)o->arcs[i][1];
        if (from < o->n_points_m && to < o->n_points_m)
            line(d, o->points_m[from], o->points_m[to]);
    }
    for (size_t i = 1; o->n_arcs == 0 && i < o->n_points_m; i++)
        line(d, o->points_m[i - 1], o->points_m[i]);
}

static void draw_operations(const struct job *job, int frame, bool all, struct shot *s, struct text *said)
{
    const struct job_key *tools = table_find(SECTION_operation, "tool");
    for (size_t i = 0; i < job->arches.n_operations; i++) {
        const struct job_operation *o = &job->arches.operations[i];
        struct drawing d = {.shot = s, .ink = &INK_TOOL};
        struct text words = {0};
        char frames[48];
        size_t n;
        if (!all && !range_holds(o->frames, frame))
            continue;
        const char *tool = choice_item(tools->choices, o->tool, &n);
        draw_operation(o, &d);
        text_add(&words, "%.*s, frames %s", (int)n, tool, range_text(o->frames, frames));
        say(said, &INK_TOOL, "arches.operations", i, words.data ? words.data : "");
        text_free(&words);
    }
}

/* A pyramid at the eye, as deep as a tenth of the scene. */
static void draw_cameras(const struct job *job, int frame, const struct job_camera *own, struct shot *s,
                         struct text *said)
{
    const double *size = job->domain.size_m, deep = 0.1 * fmax(fmax(size[0], size[1]), size[2]);
    struct drawing d = {.shot = s, .ink = &INK_CAMERA};
    for (size_t i = 0; i < job->n_cameras; i++) {
        const struct camera c = camera_of(&job->cameras[i], frame);
        double corner[4][3];
        if (&job->cameras[i] == own)
            continue;
        for (int q = 0; q < 4; q++)
            for (int k = 0; k < 3; k++)
                corner[q][k] = c.eye[k] + deep * (c.ahead[k] + (q == 1 || q == 2 ? 1 : -1) * c.right[k] +
                                                  (q > 1 ? 1 : -1) * c.down[k]);
        for (int q = 0; q < 4; q++) {
            line(&d, c.eye, corner[q]);
            line(&d, corner[q], corner[(q + 1) % 4]);
        }
        say(said, &INK_CAMERA, "cameras", SIZE_MAX, job->cameras[i].name);
    }
}

static void draw_cut(const struct job *job, const struct field_cut *cut, struct shot *s, struct text *said)
{
    const struct drawing d = {.shot = s, .ink = &INK_CUT};
    double low[3] = {0}, high[3];
    struct text words = {0};
    if (cut->keeps == CUT_NONE)
        return;
    memcpy(high, job->domain.size_m, sizeof high);
    low[cut->axis] = high[cut->axis] = cut->at;
    box(&d, low, high);
    text_add(&words, "at %c = %g m", "xyz"[cut->axis], cut -> at);
    say(said, &INK_CUT, "cut", SIZE_MAX, words.data ? words.data : "");
    text_free(&words);
}

void gizmos_draw(const struct job *job, int frame, enum gizmos which, const struct job_camera *own,
                 const struct field_cut *cut, struct shot *s, struct text *said)
{
    const bool all = which == GIZMOS_ALL;
    const double origin[3] = {0};
    struct drawing d = {.shot = s, .ink = &INK_DOMAIN};
    struct text words = {0};
    const double *size = job->domain.size_m;
    if (which == GIZMOS_NONE)
        return;
    box(&d, origin, size);
    text_add(&words, "%g x %g x %g m", size[0], size[1], size[2]);
    say(said, &INK_DOMAIN, "domain", SIZE_MAX, words.data ? words.data : "");
    text_free(&words);
    draw_cut(job, cut, s, said);
    draw_wind(job_at(job, frame), frame, s, said);
    draw_sources(job_at(job, frame), frame, s, said);
    draw_edits(job, frame, all, s, said);
    draw_operations(job, frame, all, s, said);
    draw_cameras(job, frame, own, s, said);
}
