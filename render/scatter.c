#include "render/scatter.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/random.h"
#include "base/vector.h"
#include "render/person.h"

static const double PI = 3.14159265358979323846;

/* A sequence of hashed numbers 0..1 for one object. */
struct dice {
    uint32_t a, b, c, n;
};

static double roll(struct dice *d)
{
    return (double)random_float(random_hash(d->a, d->b, d->c, ++d->n));
}

/* ---- shapes, of size 1 */

/* A stone broken along planes: a ball clipped by random planes, as a radius by direction from its middle. */
static void add_stone(int which, struct text *out)
{
    enum { PLANES = 13, ROWS = 14, COLUMNS = 22 };
    struct dice dice = {.a = 31, .b = (uint32_t)which};
    double plane[PLANES][4];
    const double flat[3] = {1, 0.75 + 0.2 * roll(&dice), 0.5 + 0.3 * roll(&dice)};
    for (int i = 0; i < PLANES; i++) {
        double z = 2 * roll(&dice) - 1, turn = 2 * PI * roll(&dice), level = sqrt(1 - z * z);
        plane[i][0] = level * cos(turn);
        plane[i][1] = level * sin(turn);
        plane[i][2] = z;
        plane[i][3] = 0.62 + 0.3 * roll(&dice);
    }
    text_add(out, "#declare Stone_%d = mesh2 {\nvertex_vectors { %d", which, (ROWS + 1) * COLUMNS);
    for (int row = 0; row <= ROWS; row++)
        for (int column = 0; column < COLUMNS; column++) {
            double up = PI * row / ROWS, turn = 2 * PI * column / COLUMNS, r = 1;
            const double d[3] = {sin(up) * cos(turn), sin(up) * sin(turn), cos(up)};
            for (int i = 0; i < PLANES; i++) {
                double along = dot3(plane[i], d);
                if (along > 0.05)
                    r = fmin(r, plane[i][3] / along);
            }
            text_add(out, ",\n<%.3f,%.3f,%.3f>", r * flat[0] * d[0], r * flat[1] * d[1], r * flat[2] * d[2]);
        }
    text_add(out, "}\nface_indices { %d", 2 * ROWS * COLUMNS);
    for (int row = 0; row < ROWS; row++)
        for (int column = 0; column < COLUMNS; column++) {
            int a = row * COLUMNS + column, b = row * COLUMNS + (column + 1) % COLUMNS;
            text_add(out, ",\n<%d,%d,%d>,\n<%d,%d,%d>", a, a + COLUMNS, b, b, a + COLUMNS, b + COLUMNS);
        }
    text_add(out, "}\n}\n");
}

static void add_leaf(const double at[3], double size, struct dice *dice, struct text *out)
{
    text_add(out, "triangle {");
    for (int corner = 0; corner < 3; corner++)
        text_add(out, "%s<%.3f,%.3f,%.3f>", corner ? "," : "", at[0] + size * (roll(dice) - 0.5),
                 at[1] + size * (roll(dice) - 0.5), at[2] + size * (roll(dice) - 0.5));
    text_add(out, "}\n");
}

/* Sagebrush: a cushion of leaves. */
static void add_bush(struct text *out)
{
    struct dice dice = {.a = 32};
    text_add(out, "#declare Plant_0 = mesh {\n");
    for (int i = 0; i < 260; i++) {
        double turn = 2 * PI * roll(&dice), z = pow(roll(&dice), 0.8), r = 0.25 + 0.75 * sqrt(roll(&dice)),
               level = 0.62 * sqrt(1 - 0.8 * z * z) * r;
        const double at[3] = {level * cos(turn), level * sin(turn), 0.06 + 0.86 * z * (0.75 + 0.25 * r)};
        add_leaf(at, 0.30, &dice, out);
    }
    text_add(
        out,
        "texture { pigment { bozo color_map { [0.3 rgb <0.17, 0.175, 0.115>] [0.7 rgb <0.27, 0.265, 0.18>] } scale 0.3 } finish { Dry } }\n}\n");
}

/* Grass: blades from one root. */
static void add_grass(struct text *out)
{
    struct dice dice = {.a = 33};
    text_add(out, "#declare Plant_1 = mesh {\n");
    for (int i = 0; i < 90; i++) {
        double turn = 2 * PI * roll(&dice), lean = 0.55 * roll(&dice), high = 0.5 + 0.5 * roll(&dice),
               x = 0.12 * (roll(&dice) - 0.5), y = 0.12 * (roll(&dice) - 0.5);
        text_add(out, "triangle {<%.3f,%.3f,0>,<%.3f,%.3f,0>,<%.3f,%.3f,%.3f>}\n", x - 0.018 * sin(turn),
                 y + 0.018 * cos(turn), x + 0.018 * sin(turn), y - 0.018 * cos(turn), x + lean * cos(turn),
                 y + lean * sin(turn), high * (1 - 0.3 * lean));
    }
    text_add(
        out,
        "texture { pigment { gradient z color_map { [0 rgb <0.20, 0.17, 0.08>] [1 rgb <0.50, 0.42, 0.22>] } } finish { Dry } }\n}\n");
}

/* Juniper: a few boughs of dense leaves on a short trunk. */
static void add_tree(struct text *out)
{
    struct dice dice = {.a = 34};
    text_add(out, "#declare Plant_2 = mesh {\n");
    for (int bough = 0; bough < 9; bough++) {
        double turn = 2.4 * bough, z = 0.22 + 0.62 * bough / 9, out_by = 0.30 * (1.1 - z);
        for (int i = 0; i < 75; i++) {
            double t = 2 * PI * roll(&dice), c = 2 * roll(&dice) - 1,
                   r = 0.23 * cbrt(roll(&dice)) * (1.25 - 0.5 * z), level = sqrt(1 - c * c);
            const double at[3] = {out_by * cos(turn) + r * level * cos(t),
                                  out_by * sin(turn) + r * level * sin(t), z + 0.9 * r * c};
            add_leaf(at, 0.10, &dice, out);
        }
    }
    text_add(
        out,
        "triangle {<-0.05,0,0>,<0.05,0,0>,<0.01,0.01,0.6>}\ntriangle {<0,-0.05,0>,<0,0.05,0>,<0.01,0.01,0.6>}\n"
        "texture { pigment { bozo color_map { [0.3 rgb <0.055, 0.075, 0.030>] [0.7 rgb <0.11, 0.125, 0.05>] } scale 0.12 } "
        "finish { Dry } }\n}\n");
}

status scatter_shapes(struct text *out)
{
    for (int i = 0; i < SCATTER_STONES; i++)
        add_stone(i, out);
    add_bush(out);
    add_grass(out);
    add_tree(out);
    return text_status(out);
}

/* ---- on the ground */

/* Objects of one kind: square cells of the ground, of which a share contains one object. */
struct kind {
    const char *shape;                         /* name of the shapes: "Stone" or "Plant" */
    double cell, least, largest, share, reach; /* m */
    double lowest; /* height above ground in units of its size, for keeping the view of the rock open */
};

static const struct kind kinds[] = {
    {"Stone", 0.22, 0.008, 0.035, 0.5, 14, 0.4}, {"Stone", 0.9, 0.03, 0.11, 0.5, 60, 0.4},
    {"Stone", 4.5, 0.09, 0.42, 0.45, 260, 0.4},  {"Stone", 21, 0.35, 1.3, 0.2, 700, 0.5},
    {"Plant", 2.2, 0.16, 0.34, 0.22, 110, 1},    {"Plant", 4.2, 0.35, 0.85, 0.38, 420, 1},
    {"Plant", 34, 1.6, 3.4, 0.3, 900, 1},
};

/* The size in px of an object of 1 m at `x`, in the camera that shows it largest; 0: no camera sees it. */
static double pixels(const struct camera *camera, size_t n, const double x[3])
{
    double most = 0;
    for (size_t i = 0; i < n; i++) {
        double px[2], d[3];
        if (!camera_project(&camera[i], x, px) || px[0] < -0.06 * camera[i].width ||
            px[0] > 1.06 * camera[i].width || px[1] < -0.06 * camera[i].height ||
            px[1] > 1.3 * camera[i].height)
            continue;
        minus3(x, camera[i].eye, d);
        most = fmax(most, 0.5 * camera[i].width / sqrt(dot3(camera[i].right, camera[i].right)) /
                              fmax(dot3(d, camera[i].ahead), 1e-6));
    }
    return most;
}

static void put_kind(const struct ground *g, const struct camera *camera, size_t n_cameras, size_t which,
                     const struct waves *patches, struct text *out)
{
    const struct kind *kind = &kinds[which];
    const struct view *v = &g->view;
    const double reach = fmin(kind->reach, 40 + 8 * v->span);
    bool stone = kind->shape[0] == 'S';
    int low[2], high[2];
    for (int a = 0; a < 2; a++) {
        low[a] = (int)floor(-reach / kind->cell);
        high[a] = (int)ceil((v->size[a] + reach) / kind->cell);
    }
    for (int j = low[1]; j <= high[1]; j++)
        for (int i = low[0]; i <= high[0]; i++) {
            struct dice dice = {(uint32_t)i, (uint32_t)j, 40 + (uint32_t)which, 0};
            double chance = roll(&dice),
                   x[3] = {(i + roll(&dice)) * kind->cell, (j + roll(&dice)) * kind->cell, 0},
                   size = kind->least * pow(kind->largest / kind->least, pow(roll(&dice), 2)),
                   away = view_outside(v, x[0], x[1]);
            if (away > reach)
                continue;
            double share = kind->share * (1 - away / reach) *
                           (0.35 + 0.9 * ramp(-0.8, 1.4, wave_at(patches, stone ? 1 : 0, x)));
            if (chance > share || !(size < 0.35 * v->span))
                continue;
            if (away > 0 ? !view_leaves_open(v, x[0], x[1], kind->lowest * size)
                         : !stone || size > 0.02 * v->span)
                continue;
            double px = pixels(camera, n_cameras, x) * size;
            if (px < 2)
                continue;
            x[2] = ground_at(g, x[0], x[1], fmax(0.5, 2 * size));
            int shape = stone ? (int)(SCATTER_STONES * roll(&dice)) : which == 4 ? 1 : which == 5 ? 0 : 2;
            /* Neither inside the rock nor on a cliff. */
            double step = fmax(0.5, size), rise = fabs(ground_at(g, x[0] + step, x[1], step) - x[2]) +
                                                  fabs(ground_at(g, x[0], x[1] + step, step) - x[2]);
            if (rise > 0.9 * step || (away <= 0 && ground_top(g, x[0], x[1]) > 0))
                continue;
            text_add(out, "object { %s_%d ", kind->shape, shape);
            if (stone)
                text_add(out, "rotate <%.0f,%.0f,%.0f> ", 40 * roll(&dice) - 20, 40 * roll(&dice) - 20,
                         360 * roll(&dice));
            else
                text_add(out, "rotate %.0f*z ", 360 * roll(&dice));
            text_add(out, "scale <%.4g,%.4g,%.4g> translate <%.4f,%.4f,%.4f> %s}\n",
                     size * (0.8 + 0.5 * roll(&dice)), size * (0.8 + 0.5 * roll(&dice)), size, x[0], x[1],
                     x[2] - (stone ? -0.18 : 0.03) * size, stone ? "texture { Rubble } " : "");
        }
}

void scatter_ground(const struct ground *g, const struct camera *camera, size_t n_cameras, struct text *out)
{
    const struct waves patches = waves_make(60, 0.2, 2, 5);
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        put_kind(g, camera, n_cameras, k, &patches, out);
}

/* ---- on the rock */

/* A triangle of the mesh, and random numbers hashed from its position. */
struct facet {
    double at[3], u[3], v[3]; /* a corner, and the edges to the other two */
    double area, up;          /* m2; z of the normal */
    struct dice dice;
};

static struct facet facet_of(const struct vdb_mesh *m, size_t i, uint32_t use)
{
    const uint32_t *t = m->triangle + 3 * i;
    const float *a = m->vertex + 3 * (size_t)t[0], *b = m->vertex + 3 * (size_t)t[1],
                *c = m->vertex + 3 * (size_t)t[2];
    struct facet f;
    double n[3];
    for (int k = 0; k < 3; k++) {
        f.at[k] = (double)a[k];
        f.u[k] = (double)b[k] - (double)a[k];
        f.v[k] = (double)c[k] - (double)a[k];
    }
    cross3(f.u, f.v, n);
    f.area = 0.5 * sqrt(dot3(n, n));
    f.up = f.area > 0 ? 0.5 * n[2] / f.area : 0;
    f.dice = (struct dice){(uint32_t)(int64_t)floor(50 * (double)a[0]) + 1000003 * use,
                           (uint32_t)(int64_t)floor(50 * (double)b[1]),
                           (uint32_t)(int64_t)floor(50 * (double)c[2]), 0};
    return f;
}

/* A random point on the triangle. */
static void spot_on(struct facet *f, double at[3])
{
    double p = roll(&f->dice), q = roll(&f->dice);
    if (p + q > 1) {
        p = 1 - p;
        q = 1 - q;
    }
    for (int k = 0; k < 3; k++)
        at[k] = f->at[k] + p * f->u[k] + q * f->v[k];
}

static double mean_of(const struct vdb_mesh *m, const float *value, size_t i)
{
    const uint32_t *t = m->triangle + 3 * i;
    return ((double)value[t[0]] + (double)value[t[1]] + (double)value[t[2]]) / 3;
}

void scatter_plants(const struct vdb_mesh *m, const float *cover, struct text *out)
{
    static const double a_m2 = 1.1; /* shrubs per m2 at full cover */
    for (size_t i = 0; i < m->n_triangles; i++) {
        double covered = mean_of(m, cover, i), at[3];
        if (covered < 0.12)
            continue;
        struct facet f = facet_of(m, i, 1);
        for (double wanted = f.up > 0.45 ? a_m2 * f.area * covered : 0; wanted > 0;
             wanted -= 1) { /* walls have none */
            if (roll(&f.dice) > wanted)
                break;
            spot_on(&f, at);
            double size = (0.22 + 0.5 * roll(&f.dice)) * (0.5 + 0.6 * covered), kind = roll(&f.dice);
            text_add(out, "object { Plant_%d scale %.3f rotate %.0f*z translate <%.3f,%.3f,%.3f> }\n",
                     kind < 0.3     ? 1
                     : kind < 0.985 ? 0
                                    : 2,
                     kind < 0.985 ? size : 3.5 * size, 360 * roll(&f.dice), at[0], at[1],
                     at[2] - 0.04 * size);
        }
    }
}

void scatter_scree(const struct vdb_mesh *m, const float *loose, double pixel, struct text *out)
{
    static const double a_m2 = 0.9, least = 0.14, largest = 1.5;
    for (size_t i = 0; i < m->n_triangles; i++) {
        double at[3];
        if (mean_of(m, loose, i) < 0.5)
            continue;
        struct facet f = facet_of(m, i, 2);
        for (double wanted = f.up > 0.4 ? a_m2 * f.area : 0; wanted > 0; wanted -= 1) {
            if (roll(&f.dice) > wanted)
                break;
            spot_on(&f, at);
            double size = least * pow(largest / least, pow(roll(&f.dice), 3));
            if (size < 2 * pixel)
                continue;
            text_add(
                out,
                "object { Stone_%d scale <%.3g,%.3g,%.3g> rotate <%.0f,%.0f,%.0f> translate <%.3f,%.3f,%.3f> texture { Rubble } }\n",
                (int)(SCATTER_STONES * roll(&f.dice)), 0.5 * size * (0.8 + 0.4 * roll(&f.dice)),
                0.5 * size * (0.8 + 0.4 * roll(&f.dice)), 0.5 * size, 50 * roll(&f.dice) - 25,
                50 * roll(&f.dice) - 25, 360 * roll(&f.dice), at[0], at[1], at[2] + 0.05 * size);
        }
    }
}

void scatter_rocks(const struct job *job, const struct rock *at, double radius, struct text *out)
{
    for (size_t i = 0; i < at->n; i++) {
        struct dice dice = {at->id ? at->id[i] : (uint32_t)i, 0, 60, 0};
        /* Many small rocks and few large ones, which still touch each other. */
        double size = radius * (0.45 + 1.15 * pow(roll(&dice), 2.2));
        size_t bed = (size_t)(roll(&dice) * (double)job->n_strata);
        text_add(
            out,
            "object { Stone_%d scale %.4g rotate <%.0f,%.0f,%.0f> translate <%.4f,%.4f,%.4f> texture { Rubble_Bed[%zu] } }\n",
            (int)(SCATTER_STONES * roll(&dice)), size, 360 * roll(&dice), 360 * roll(&dice),
            360 * roll(&dice), (double)at->P[4 * i] + 0.4 * radius * (roll(&dice) - 0.5),
            (double)at->P[4 * i + 1] + 0.4 * radius * (roll(&dice) - 0.5),
            (double)at->P[4 * i + 2] - 0.3 * (radius - size), bed < job->n_strata ? bed : 0);
    }
}

/* ---- the person */

/* The height of the rock or ground on which the person would stand. */
static double stands_at(const struct ground *g, double x, double y)
{
    return fmax(ground_at(g, x, y, 0.5), ground_top(g, x, y));
}

void scatter_figure(const struct ground *g, const struct camera *c, struct text *out)
{
    const struct view *v = &g->view;
    double towards[2] = {c->eye[0] - 0.5 * v->size[0], c->eye[1] - 0.5 * v->size[1]},
           length = fmax(hypot(towards[0], towards[1]), 1e-9), x = 0, y = 0, z = 0;
    /* Search from the middle of the box towards the camera, slightly to the side, for the first low place that is level
     * within one step. */
    for (double t = 0; t < 1.2 * v->span + 30; t += 0.1) {
        x = 0.5 * v->size[0] + (t * towards[0] - 0.14 * v->span * towards[1]) / length;
        y = 0.5 * v->size[1] + (t * towards[1] + 0.14 * v->span * towards[0]) / length;
        z = stands_at(g, x, y);
        bool level = z < 0.3 * v->size[2];
        for (int k = 0; k < 8 && level; k++)
            level = fabs(stands_at(g, x + 0.9 * cos(k * PI / 4), y + 0.9 * sin(k * PI / 4)) - z) < 0.4;
        if (level)
            break;
    }
    text_add(out, "// a person of 1.75 m\nunion {\n");
    for (int i = 0; i < PERSON_PARTS; i++) {
        const struct person_part *p = &person_part[i];
        if (p->rb < 0)
            text_add(out, "    sphere { 0, %g scale <%g, %g, %g> translate <%g, %g, %g>", p->ra,
                     p->stretch[0], p->stretch[1], p->stretch[2], p->a[0], p->a[1], p->a[2]);
        else
            text_add(out, "    cone { <%g, %g, %g>, %g, <%g, %g, %g>, %g", p->a[0], p->a[1], p->a[2], p->ra,
                     p->b[0], p->b[1], p->b[2], p->rb);
        text_add(out, " pigment { rgb <%g, %g, %g> } }\n", p->rgb[0], p->rgb[1], p->rgb[2]);
    }
    text_add(out, "    finish { Dry }\n    rotate %.1f * z\n    translate <%.4f, %.4f, %.4f>\n}\n",
             atan2(towards[1], towards[0]) * 180 / PI + 60, x, y, z);
}
