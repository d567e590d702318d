#include "render/ground.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "shared/params.h"

static const double FAR = 25000; /* m: farther away than the visible horizon */

enum { APRON_NODES = 4 };

/* ---- the rock from above */

static double cross2(const float *a, const float *b, double x, double y)
{
    return ((double)b[0] - (double)a[0]) * (y - (double)a[1]) -
           ((double)b[1] - (double)a[1]) * (x - (double)a[0]);
}

/* The highest point of a triangle over each node. */
static void put_triangle(struct ground *g, const struct vdb_mesh *m, const uint32_t t[3])
{
    const float *v[3];
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        v[i] = m->vertex + 3 * (size_t)t[i];
        for (int a = 0; a < 2; a++) {
            low[a] = fmin(low[a], (double)v[i][a]);
            high[a] = fmax(high[a], (double)v[i][a]);
        }
    }
    double area = cross2(v[0], v[1], (double)v[2][0], (double)v[2][1]);
    if (area == 0)
        return;
    for (int j = (int)fmax(ceil(low[1] / g->dy), 0); j < g->ny && j * g->dy <= high[1]; j++)
        for (int i = (int)fmax(ceil(low[0] / g->dx), 0); i < g->nx && i * g->dx <= high[0]; i++) {
            double x = i * g->dx, y = j * g->dy, w[3], z = 0;
            bool in = true;
            for (int k = 0; k < 3; k++) {
                w[k] = cross2(v[(k + 1) % 3], v[(k + 2) % 3], x, y) / area;
                in &= w[k] >= -1e-6;
                z += w[k] * (double)v[k][2];
            }
            float *top = &g->top[j * g->nx + i];
            if (in && z > (double)*top)
                *top = (float)z;
        }
}

/* Surfaces end slightly inside the box, and at a wall they are rounded although the rock continues. So the outermost nodes take the heights
 * of nodes one or two further in. */
static void fill_edges(struct ground *g)
{
    int low[2] = {g->walls & WALL_X_MIN ? 2 : 1, g->walls & WALL_Y_MIN ? 2 : 1},
        high[2] = {g->nx - 1 - (g->walls & WALL_X_MAX ? 2 : 1), g->ny - 1 - (g->walls & WALL_Y_MAX ? 2 : 1)};
    for (int j = 0; j < g->ny; j++)
        for (int i = 0; i < g->nx; i++) {
            int x = i < low[0]    ? low[0]
                    : i > high[0] ? high[0]
                                  : i,
                y = j < low[1]    ? low[1]
                    : j > high[1] ? high[1]
                                  : j;
            if (x != i || y != j)
                g->top[j * g->nx + i] = fmaxf(g->top[j * g->nx + i], g->top[y * g->nx + x]);
        }
}

/* The apron at the foot of the rock: half as high as the rock there but at most `most`, and falling to 0 over a few nodes. */
static void find_apron(struct ground *g, double most)
{
    for (int j = 0; j < g->ny; j++)
        for (int i = 0; i < g->nx; i++) {
            double best = 0;
            for (int b = -APRON_NODES; b <= APRON_NODES; b++)
                for (int a = -APRON_NODES; a <= APRON_NODES; a++) {
                    int x = i + a, y = j + b;
                    double far = hypot(a, b) / APRON_NODES;
                    if (x < 0 || y < 0 || x >= g->nx || y >= g->ny || far >= 1)
                        continue;
                    double from = fmin(0.5 * (double)g->top[y * g->nx + x], most);
                    best = fmax(best, from * (1 - far) * (1 - far));
                }
            g->apron[j * g->nx + i] = (float)best;
        }
}

status ground_make(const struct job *job, const struct view *view, const struct vdb_mesh *mesh,
                   struct ground *g)
{
    enum { MOST = 300 };
    status st = OK;
    double h = job->domain.spacing_m;
    *g = (struct ground){.view = *view, .walls = job_walls(job), .lean = fmax(2.5 * h, 0.1 * view->size[2])};
    g->nx = (int)fmin(fmax(ceil(view->size[0] / h), 8), MOST) + 1;
    g->ny = (int)fmin(fmax(ceil(view->size[1] / h), 8), MOST) + 1;
    g->dx = view->size[0] / (g->nx - 1);
    g->dy = view->size[1] / (g->ny - 1);
    g->waves = waves_make(480, 0.4, 9, 1);
    TRY(memory_alloc((size_t)g->nx * (size_t)g->ny, sizeof *g->top, "the ground", &g->top));
    TRY(memory_alloc((size_t)g->nx * (size_t)g->ny, sizeof *g->apron, "the ground", &g->apron));
    for (size_t i = 0; i < mesh->n_triangles; i++)
        put_triangle(g, mesh, mesh->triangle + 3 * i);
    fill_edges(g);
    find_apron(g, 0.9 * h);
done:
    if (st != OK)
        ground_free(g);
    return st;
}

void ground_free(struct ground *g)
{
    free(g->top);
    free(g->apron);
    g->top = g->apron = NULL;
}

/* ---- heights */

static double sampled(const struct ground *g, const float *field, double x, double y)
{
    double u = fmin(fmax(x / g->dx, 0), g->nx - 1.001), v = fmin(fmax(y / g->dy, 0), g->ny - 1.001);
    int i = (int)u, j = (int)v;
    const float *at = field + j * g->nx + i;
    u -= i;
    v -= j;
    return (1 - v) * ((1 - u) * (double)at[0] + u * (double)at[1]) +
           v * ((1 - u) * (double)at[g->nx] + u * (double)at[g->nx + 1]);
}

double ground_top(const struct ground *g, double x, double y)
{
    return view_outside(&g->view, x, y) > 0 ? 0 : sampled(g, g->top, x, y);
}

double ground_at(const struct ground *g, double x, double y, double finest)
{
    const double *size = g->view.size;
    double away = view_outside(&g->view, x, y), cx = fmin(fmax(x, 0), size[0]),
           cy = fmin(fmax(y, 0), size[1]), relief = 0;
    if (away <= 0)
        return sampled(g, g->apron, x, y);
    /* The distances of a place beyond walls and beyond open sides. */
    double walled = hypot(x < 0 && g->walls & WALL_X_MIN         ? -x
                          : x > size[0] && g->walls & WALL_X_MAX ? x - size[0]
                                                                 : 0,
                          y < 0 && g->walls & WALL_Y_MIN         ? -y
                          : y > size[1] && g->walls & WALL_Y_MAX ? y - size[1]
                                                                 : 0),
           open = sqrt(fmax(away * away - walled * walled, 0)), top = sampled(g, g->top, cx, cy),
           height = top;
    if (open > 1e-9) {
        double lean = fmin(top, g->lean), left = fmax(1 - open / fmax(3.5 * lean, 1e-9), 0);
        height = lean > 0 ? lean * left * left : 0;
    }
    height = fmax(height, sampled(g, g->apron, cx, cy) * fmax(1 - away / (APRON_NODES * g->dx), 0));
    const double at[3] = {x, y, 0};
    for (size_t i = 0; i < g->waves.n; i++) {
        double length = g->waves.length[i], shown = ramp(1, 2, length / finest);
        if (shown > 0)
            relief += shown * ramp(0, 0.6 * length, away) * 0.011 * length * pow(length / 480, 0.12) *
                      wave_at(&g->waves, i, at);
    }
    double most = 0.8 * g->view.slope * away;
    /* Hills are flattened to stay below the line of sight; valleys are unchanged. */
    relief = relief > 0 && most > 0 ? most * tanh(relief / most) : relief > 0 ? 0 : relief;
    return height + relief;
}

/* ---- its mesh: a grid over the box, and rings around it that grow with their distance */

struct patch {
    int nx, ny;
    double (*at)[3];
};

static void add_patch(struct text *out, const struct patch *p, bool closed)
{
    text_add(out, "mesh2 {\nvertex_vectors { %d", p->nx * p->ny);
    for (int i = 0; i < p->nx * p->ny; i++) {
        int digits = (int)fmin(fmax(4 - log10(fmax(hypot(p->at[i][0], p->at[i][1]), 1e-3)), 1), 6);
        text_add(out, ",\n<%.*f,%.*f,%.*f>", digits, p->at[i][0], digits, p->at[i][1], digits, p->at[i][2]);
    }
    text_add(out, "}\nnormal_vectors { %d", p->nx * p->ny);
    for (int j = 0; j < p->ny; j++)
        for (int i = 0; i < p->nx; i++) {
            int left = i > 0    ? i - 1
                       : closed ? p->nx - 1
                                : 0,
                right = i + 1 < p->nx ? i + 1
                        : closed      ? 0
                                      : i,
                below = j > 0 ? j - 1 : 0, above = j + 1 < p->ny ? j + 1 : j;
            const double *a = p->at[j * p->nx + left], *b = p->at[j * p->nx + right],
                         *c = p->at[below * p->nx + i], *d = p->at[above * p->nx + i];
            double u[3], v[3], n[3], length;
            for (int k = 0; k < 3; k++) {
                u[k] = b[k] - a[k];
                v[k] = d[k] - c[k];
            }
            n[0] = u[1] * v[2] - u[2] * v[1];
            n[1] = u[2] * v[0] - u[0] * v[2];
            n[2] = u[0] * v[1] - u[1] * v[0];
            length = copysign(fmax(sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), 1e-30), n[2]);
            text_add(out, ",\n<%.3f,%.3f,%.3f>", n[0] / length, n[1] / length, n[2] / length);
        }
    int columns = closed ? p->nx : p->nx - 1;
    text_add(out, "}\nface_indices { %d", 2 * columns * (p->ny - 1));
    for (int j = 0; j + 1 < p->ny; j++)
        for (int i = 0; i < columns; i++) {
            int a = j * p->nx + i, b = j * p->nx + (i + 1) % p->nx;
            text_add(out, ",\n<%d,%d,%d>,\n<%d,%d,%d>", a, b, a + p->nx, b, b + p->nx, a + p->nx);
        }
    text_add(out, "}\n}\n");
}

/* The distance from the middle of the box to its outline in a direction. */
static double outline(const struct view *v, double c, double s)
{
    return fmin(fabs(c) > 1e-9 ? 0.5 * v->size[0] / fabs(c) : INFINITY,
                fabs(s) > 1e-9 ? 0.5 * v->size[1] / fabs(s) : INFINITY);
}

/* The height of the grid inside the box. Next to a wall it rises to just below the rock, whose own surface is rounded there. */
static double floor_at(const struct ground *g, int i, int j)
{
    double apron = (double)g->apron[j * g->nx + i], top = (double)g->top[j * g->nx + i];
    int walls[4] = {i, g->nx - 1 - i, j, g->ny - 1 - j}, nearest = 99;
    for (int side = 0; side < 4; side++)
        if (g->walls & WALL_X_MIN << side && walls[side] < nearest)
            nearest = walls[side];
    return nearest < 2 ? fmax(apron, top - (nearest ? 0.3 * fmin(g->dx, g->dy) : 0)) : apron;
}

status ground_write(const struct ground *g, int turns, struct text *out)
{
    status st = OK;
    const double *size = g->view.size, grow = 2 * 3.14159265358979 / turns, edge = fmin(g->dx, g->dy),
                 first = fmax(0.25 * fmin(size[0], size[1]) * grow, 0.61 * edge),
                 start =
                     -0.6 *
                     edge; /* the first ring is just below the edge of the grid, so that there is no gap */
    struct patch box = {.nx = g->nx, .ny = g->ny}, rings = {.nx = turns};
    for (double away = start, step = first; away < FAR; rings.ny++) {
        away += step;
        step = fmax(step, grow * (away + 0.5 * fmin(size[0], size[1])));
    }
    TRY(memory_alloc((size_t)(g->nx * g->ny), sizeof *box.at, "the ground", &box.at));
    TRY(memory_alloc((size_t)(rings.nx * rings.ny), sizeof *rings.at, "the ground", &rings.at));
    for (int j = 0; j < g->ny; j++)
        for (int i = 0; i < g->nx; i++) {
            double *at = box.at[j * g->nx + i];
            at[0] = i * g->dx;
            at[1] = j * g->dy;
            at[2] = floor_at(g, i, j);
        }
    double away = start, step = first;
    for (int ring = 0; ring < rings.ny; ring++) {
        for (int turn = 0; turn < turns; turn++) {
            double a = grow * turn, c = cos(a), s = sin(a), r = outline(&g->view, c, s) + away,
                   *at = rings.at[ring * turns + turn];
            at[0] = 0.5 * size[0] + r * c;
            at[1] = 0.5 * size[1] + r * s;
            at[2] = ring ? ground_at(g, at[0], at[1], 1.2 * fmax(step, grow * r))
                         : floor_at(g, (int)lrint(at[0] / g->dx), (int)lrint(at[1] / g->dy)) - 0.05 * edge;
        }
        away += step;
        step = fmax(step, grow * (away + 0.5 * fmin(size[0], size[1])));
    }
    text_add(out, "\n#declare Ground_Near = ");
    add_patch(out, &box, false);
    text_add(out, "#declare Ground_Far = ");
    add_patch(out, &rings, true);
done:
    free(box.at);
    free(rings.at);
    return st;
}
