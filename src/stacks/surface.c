#include "stacks/surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* The stacks that the box overlaps on one axis, and the lengths of the overlaps, m. Outside of the grid the outermost stacks continue. */
struct span {
    int n, index[2 * SURFACE_WIDEST + 3];
    double overlap[2 * SURFACE_WIDEST + 3];
};

static int inside(int i, int n)
{
    return i < 0 ? 0 : i < n ? i : n - 1;
}

static struct span span_of(const struct stacks *s, int axis, double x, double sigma)
{
    struct span out = {0};
    double lo = x - sigma, hi = x + sigma;
    double first = floor(lo / s->cell);
    for (int k = 0; k < 2 * SURFACE_WIDEST + 3; k++) {
        double from = fmax(lo, (first + k) * s->cell), to = fmin(hi, (first + k + 1) * s->cell);
        if ((first + k) * s->cell >= hi)
            break;
        if (to <= from)
            continue;
        double at = fmin(fmax(first + k, 0), s->n[axis] - 1);
        if (out.n && out.index[out.n - 1] == (int)at) {
            out.overlap[out.n - 1] += to - from;
            continue;
        }
        out.index[out.n] = (int)at;
        out.overlap[out.n++] = to - from;
    }
    return out;
}

/* The length of the set's materials in lo..hi of a stack, m. */
static double length_in(const struct surface *s, int i, int j, double lo, double hi)
{
    size_t n;
    const uint32_t *layer = stacks_column(s->stacks, i, j, &n);
    double sum = 0, bottom = -INFINITY;
    for (size_t k = 0; k < n && bottom < hi; k++) {
        double top = layer_top(layer[k]) * s->stacks->quantum;
        if (s->set >> layer_material(layer[k]) & 1)
            sum += fmax(0, fmin(top, hi) - fmax(bottom, lo));
        bottom = top;
    }
    if (s->set >> MATERIAL_AIR & 1)
        sum += fmax(0, hi - fmax(bottom, lo));
    return sum;
}

double surface_at(const struct surface *s, const double p[3])
{
    struct span x = span_of(s->stacks, 0, p[0], s->sigma), y = span_of(s->stacks, 1, p[1], s->sigma);
    double volume = 0;
    for (int j = 0; j < y.n; j++)
        for (int i = 0; i < x.n; i++)
            volume += x.overlap[i] * y.overlap[j] *
                      length_in(s, x.index[i], y.index[j], p[2] - s->sigma, p[2] + s->sigma);
    return volume / (4 * s->sigma * s->sigma * s->sigma) - 1;
}

/* The area of the set's materials on the face of the box that is normal to `axis` (0 or 1) at coordinate `at`. */
static double face_area(const struct surface *s, int axis, double at, const struct span *other, double z)
{
    int own =
        inside((int)fmin(fmax(floor(at / s->stacks->cell), -1), s->stacks->n[axis]), s->stacks->n[axis]);
    double area = 0;
    for (int k = 0; k < other->n; k++)
        area += other->overlap[k] * length_in(s, axis == 0 ? own : other->index[k],
                                              axis == 0 ? other->index[k] : own, z - s->sigma, z + s->sigma);
    return area;
}

static bool set_at(const struct surface *s, int i, int j, double z)
{
    size_t n;
    const uint32_t *layer = stacks_column(s->stacks, i, j, &n);
    for (size_t k = 0; k < n; k++)
        if (z < layer_top(layer[k]) * s->stacks->quantum)
            return s->set >> layer_material(layer[k]) & 1;
    return s->set >> MATERIAL_AIR & 1;
}

void surface_gradient(const struct surface *s, const double p[3], double gradient[3])
{
    double sigma = s->sigma;
    struct span x = span_of(s->stacks, 0, p[0], sigma), y = span_of(s->stacks, 1, p[1], sigma);
    gradient[0] = face_area(s, 0, p[0] + sigma, &y, p[2]) - face_area(s, 0, p[0] - sigma, &y, p[2]);
    gradient[1] = face_area(s, 1, p[1] + sigma, &x, p[2]) - face_area(s, 1, p[1] - sigma, &x, p[2]);
    gradient[2] = 0;
    for (int j = 0; j < y.n; j++)
        for (int i = 0; i < x.n; i++)
            gradient[2] += x.overlap[i] * y.overlap[j] *
                           (set_at(s, x.index[i], y.index[j], p[2] + sigma) -
                            set_at(s, x.index[i], y.index[j], p[2] - sigma));
    for (int a = 0; a < 3; a++)
        gradient[a] /= 4 * sigma * sigma * sigma;
}

void surface_normal(const struct surface *s, const double p[3], double normal[3])
{
    surface_gradient(s, p, normal);
    double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (int a = 0; a < 3; a++)
        normal[a] = length > 0 ? -normal[a] / length : a == 2;
}

/* ---- f along a vertical line */

struct profile_event {
    double z, slope; /* change of f's slope at z */
};

void profile_free(struct profile *p)
{
    free(p->z);
    free(p->f);
    free(p->event);
    *p = (struct profile){0};
}

static int by_height(const void *a, const void *b)
{
    const struct profile_event *x = a, *y = b;
    return (x->z > y->z) - (x->z < y->z);
}

/* Adds the events of a stack: the box's top reaches each boundary sigma below it, its bottom leaves it sigma above. */
static status add_column(const struct surface *s, int i, int j, double weight, struct profile *p,
                         double *below)
{
    size_t n;
    const uint32_t *layer = stacks_column(s->stacks, i, j, &n);
    status st =
        memory_grow(&p->event, &p->event_capacity, p->n_events + 2 * n, sizeof *p->event, "a profile");
    if (st != OK)
        return st;
    bool in = s->set >> (n ? layer_material(layer[0]) : (uint32_t)MATERIAL_AIR) & 1;
    *below += weight * (in ? 1 : -1);
    for (size_t k = 0; k < n; k++) {
        bool above = s->set >> (k + 1 < n ? layer_material(layer[k + 1]) : (uint32_t)MATERIAL_AIR) & 1;
        double z = layer_top(layer[k]) * s->stacks->quantum;
        double slope = above == in ? 0 : (above ? weight : -weight) / s->sigma;
        in = above;
        if (slope == 0)
            continue;
        p->event[p->n_events++] = (struct profile_event){z - s->sigma, slope};
        p->event[p->n_events++] = (struct profile_event){z + s->sigma, -slope};
    }
    return OK;
}

static status reserve(struct profile *p, size_t n)
{
    status st = OK;
    size_t was = p->capacity;
    TRY(memory_grow(&p->z, &was, n, sizeof *p->z, "a profile"));
    TRY(memory_grow(&p->f, &p->capacity, n, sizeof *p->f, "a profile"));
done:
    return st;
}

status surface_profile(const struct surface *s, double x, double y, struct profile *p)
{
    status st = OK;
    struct span along = span_of(s->stacks, 0, x, s->sigma), across = span_of(s->stacks, 1, y, s->sigma);
    double area = 4 * s->sigma * s->sigma, below = 0, slope = 0;
    p->n = p->n_events = 0;
    for (int j = 0; j < across.n; j++)
        for (int i = 0; i < along.n; i++)
            TRY(add_column(s, along.index[i], across.index[j], along.overlap[i] * across.overlap[j] / area, p,
                           &below));
    /* The order of equal heights does not matter: their slopes are summed, and the order only affects rounding. */
    qsort(p->event, p->n_events, sizeof *p->event, by_height);
    TRY(reserve(p, p->n_events + 1));
    p->z[0] = p->n_events ? p->event[0].z : 0;
    p->f[0] = fmin(fmax(below, -1), 1);
    p->n = 1;
    for (size_t e = 0; e < p->n_events; e++) {
        double z = p->event[e].z, last = p->z[p->n - 1];
        if (z > last) {
            p->z[p->n] = z;
            p->f[p->n] = fmin(fmax(p->f[p->n - 1] + slope * (z - last), -1), 1);
            p->n++;
        }
        slope += p->event[e].slope;
    }
done:
    return st;
}

double profile_at(const struct profile *p, double z)
{
    size_t lo = 0, hi = p->n - 1;
    if (z <= p->z[0])
        return p->f[0];
    if (z >= p->z[hi])
        return p->f[hi];
    while (hi - lo > 1) {
        size_t middle = (lo + hi) / 2;
        if (p->z[middle] <= z)
            lo = middle;
        else
            hi = middle;
    }
    return p->f[lo] + (p->f[hi] - p->f[lo]) * (z - p->z[lo]) / (p->z[hi] - p->z[lo]);
}

/* ---- projection */

static bool nearest_root(const struct profile *p, double z, double *out)
{
    bool found = false;
    for (size_t k = 0; k + 1 < p->n; k++) {
        double a = p->f[k], b = p->f[k + 1];
        if ((a > 0) == (b > 0))
            continue;
        double root = p->z[k] + (p->z[k + 1] - p->z[k]) * a / (a - b);
        if (!found || fabs(root - z) < fabs(*out - z))
            *out = root;
        found = true;
    }
    return found;
}

/* Moves p to the nearest root on its vertical line. */
static status drop_to_root(const struct surface *s, double p[3], bool *found)
{
    struct profile line = {0};
    status st = surface_profile(s, p[0], p[1], &line);
    *found = st == OK && nearest_root(&line, p[2], &p[2]);
    profile_free(&line);
    return st;
}

status surface_project(const struct surface *s, double p[3], bool *found)
{
    status st = OK;
    double f = surface_at(s, p);
    *found = true;
    if (fabs(f) > 0.999)
        TRY(drop_to_root(s, p, found));
    for (int i = 0; i < 20 && *found; i++) {
        double g[3];
        f = surface_at(s, p);
        surface_gradient(s, p, g);
        double square = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];
        if (fabs(f) < 1e-6 || !(square > 0))
            break;
        /* A Newton step, limited to half of sigma, for the gradient is only valid around p. */
        double step = fmin(fabs(f) / sqrt(square), s->sigma / 2) * (f > 0 ? -1 : 1) / sqrt(square);
        for (int a = 0; a < 3; a++)
            p[a] += step * g[a];
    }
    if (*found && fabs(surface_at(s, p)) > 1e-6)
        TRY(drop_to_root(s, p, found));
done:
    return st;
}

/* ---- samples on a lattice */

/* Adds weight times the share of the set in the window of each sample, along one stack, for samples first to first + n - 1. */
static void add_line(const struct surface *s, int i, int j, double weight, double origin, double h, int first,
                     int n, float *line)
{
    size_t layers;
    const uint32_t *layer = stacks_column(s->stacks, i, j, &layers);
    double q = s->stacks->quantum, bottom = -INFINITY;
    float whole = (float)weight;
    for (size_t k = 0; k <= layers; k++) {
        double top = k < layers ? layer_top(layer[k]) * q : INFINITY;
        uint32_t material = k < layers ? layer_material(layer[k]) : (uint32_t)MATERIAL_AIR;
        if (s->set >> material & 1) {
            double lo = bottom - s->sigma, hi = top + s->sigma;
            int from = (int)fmin(fmax(ceil((lo - origin) / h), first), first + n);
            int to = (int)fmin(fmax(floor((hi - origin) / h), first - 1), first + n - 1);
            for (int z = from; z <= to; z++) {
                double at = origin + z * h;
                double part = fmin(top, at + s->sigma) - fmax(bottom, at - s->sigma);
                line[z - first] +=
                    part >= 2 * s->sigma ? whole : (float)(weight * fmax(part, 0) / (2 * s->sigma));
            }
        }
        bottom = top;
    }
}

/* The stacks *lo to *hi that the boxes around a row of points overlap on an axis. */
static void stacks_along(const struct surface *s, int axis, const struct surface_box *box, int *lo, int *hi)
{
    const int last = box->first[axis] + box->n[axis] - 1;
    const struct span from =
        span_of(s->stacks, axis, box->origin[axis] + box->first[axis] * box->h, s->sigma);
    const struct span to = span_of(s->stacks, axis, box->origin[axis] + last * box->h, s->sigma);
    *lo = from.index[0];
    *hi = to.index[to.n - 1];
}

/* Samples row j of the box: filters along z and y into `lines` for stacks lo to hi, then along x. */
static void sample_row(const struct surface *s, const struct surface_box *box, int j, int lo, int hi,
                       float *lines, float *row, float *share)
{
    const size_t nz = (size_t)box->n[2];
    const double h = box->h, bottom = box->origin[2];
    const struct span y = span_of(s->stacks, 1, box->origin[1] + (box->first[1] + j) * h, s->sigma);
    memset(lines, 0, (size_t)(hi - lo + 1) * nz * sizeof *lines);
    for (int c = 0; c < y.n; c++)
        for (int i = lo; i <= hi; i++)
            add_line(s, i, y.index[c], y.overlap[c] / (2 * s->sigma), bottom, h, box->first[2], box->n[2],
                     lines + (size_t)(i - lo) * nz);
    for (int i = 0; i < box->n[0]; i++) {
        const struct span x = span_of(s->stacks, 0, box->origin[0] + (box->first[0] + i) * h, s->sigma);
        memset(row, 0, nz * sizeof *row);
        for (int c = 0; c < x.n; c++) {
            const float *line = lines + (size_t)(x.index[c] - lo) * nz;
            float weight = (float)(x.overlap[c] / (2 * s->sigma));
            for (size_t z = 0; z < nz; z++)
                row[z] += weight * line[z];
        }
        for (size_t z = 0; z < nz; z++)
            share[(z * (size_t)box->n[1] + (size_t)j) * (size_t)box->n[0] + (size_t)i] = fminf(row[z], 1);
    }
}

status surface_sample(const struct surface *s, const struct surface_box *box, struct surface_scratch *scratch,
                      float *share)
{
    int lo, hi;
    stacks_along(s, 0, box, &lo, &hi);
    const size_t nz = (size_t)box->n[2], lines = (size_t)(hi - lo + 1) * nz;
    status st = memory_grow(&scratch->line, &scratch->capacity, lines + nz, sizeof *scratch->line, "samples");
    for (int j = 0; st == OK && j < box->n[1]; j++)
        sample_row(s, box, j, lo, hi, scratch->line, scratch->line + lines, share);
    return st;
}

/* ---- visible area */

/* The material of layer k and its extent lo..hi, quanta; air above the last layer. */
static uint32_t layer_span(const uint32_t *layer, size_t n, size_t k, double *lo, double *hi)
{
    *lo = k ? (double)layer_top(layer[k - 1]) : -HUGE_VAL;
    *hi = k < n ? (double)layer_top(layer[k]) : HUGE_VAL;
    return k < n ? layer_material(layer[k]) : (uint32_t)MATERIAL_AIR;
}

static bool is_open(uint32_t material)
{
    return material == MATERIAL_AIR || material == MATERIAL_WATER;
}

/* Adds the wall between two neighbouring stacks within lo..hi (quanta): the material of one that faces the air of the other. */
static void add_wall(const struct stacks *s, const int a[2], const int b[2], double width, double lo,
                     double hi, double area[MATERIALS_MAX])
{
    size_t n[2], k[2] = {0, 0};
    const uint32_t *layer[2] = {stacks_column(s, a[0], a[1], &n[0]), stacks_column(s, b[0], b[1], &n[1])};
    while (k[0] <= n[0] && k[1] <= n[1]) {
        double from[2], to[2];
        uint32_t m[2];
        for (int side = 0; side < 2; side++)
            m[side] = layer_span(layer[side], n[side], k[side], &from[side], &to[side]);
        double length = fmin(fmin(to[0], to[1]), hi) - fmax(fmax(from[0], from[1]), lo);
        if (length > 0 && is_open(m[0]) != is_open(m[1]))
            area[is_open(m[0]) ? m[1] : m[0]] += length * s->quantum * width;
        if (fmin(to[0], to[1]) >= hi)
            break;
        k[to[0] <= to[1] ? 0 : 1]++;
    }
}

void surface_visible(const struct surface *s, const double p[3], double area[MATERIALS_MAX])
{
    const struct stacks *g = s->stacks;
    struct span x = span_of(g, 0, p[0], s->sigma), y = span_of(g, 1, p[1], s->sigma);
    double lo = (p[2] - s->sigma) / g->quantum, hi = (p[2] + s->sigma) / g->quantum;
    memset(area, 0, MATERIALS_MAX * sizeof *area);
    for (int j = 0; j < y.n; j++)
        for (int i = 0; i < x.n; i++) {
            size_t n;
            const int at[2] = {x.index[i], y.index[j]};
            const uint32_t *layer = stacks_column(g, at[0], at[1], &n);
            for (size_t k = 0; k < n; k++) {
                double top = layer_top(layer[k]);
                uint32_t below = layer_material(layer[k]);
                uint32_t above = k + 1 < n ? layer_material(layer[k + 1]) : (uint32_t)MATERIAL_AIR;
                if (top >= lo && top <= hi && is_open(below) != is_open(above))
                    area[is_open(below) ? above : below] += x.overlap[i] * y.overlap[j];
            }
            if (i + 1 < x.n)
                add_wall(g, at, (const int[]){x.index[i + 1], at[1]}, y.overlap[j], lo, hi, area);
            if (j + 1 < y.n)
                add_wall(g, at, (const int[]){at[0], y.index[j + 1]}, x.overlap[i], lo, hi, area);
        }
}
