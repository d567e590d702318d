#include "render/refine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/random.h"
#include "geology/attitude.h"
#include "render/waves.h"

/* ---- subdivision: a triangle into four, at the midpoints of its edges */

struct edges {
    uint64_t *key; /* both ends of the edge; 0: free slot */
    uint32_t *middle;
    size_t mask;
};

static uint32_t middle_of(struct edges *e, uint32_t a, uint32_t b, size_t *n)
{
    uint64_t key = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
    size_t i = random_hash(a < b ? a : b, a < b ? b : a, 0, 0) & e->mask;
    while (e->key[i] != 0 && e->key[i] != key)
        i = (i + 1) & e->mask;
    if (e->key[i] == 0) {
        e->key[i] = key;
        e->middle[i] = (uint32_t)(*n)++;
    }
    return e->middle[i];
}

static void put_middle(const struct vdb_mesh *m, size_t n_values, uint32_t a, uint32_t b, uint32_t at,
                       size_t most, struct vdb_mesh *out)
{
    for (int k = 0; k < 3; k++) {
        out->vertex[3 * at + (size_t)k] =
            0.5F * (m->vertex[3 * a + (size_t)k] + m->vertex[3 * b + (size_t)k]);
        out->normal[3 * at + (size_t)k] =
            0.5F * (m->normal[3 * a + (size_t)k] + m->normal[3 * b + (size_t)k]);
    }
    for (size_t v = 0; v < n_values; v++)
        out->value[v * most + at] =
            0.5F * (m->value[v * m->n_vertices + a] + m->value[v * m->n_vertices + b]);
}

static status cut(struct vdb_mesh *m, size_t n_values)
{
    status st = OK;
    struct edges e = {.mask = 1};
    /* A closed surface has three edges per two triangles. */
    size_t n = m->n_vertices, most = n + 3 * m->n_triangles;
    struct vdb_mesh fine = {.n_triangles = 4 * m->n_triangles};
    while (e.mask + 1 < 4 * m->n_triangles)
        e.mask = 2 * e.mask + 1;
    TRY(memory_alloc(e.mask + 1, sizeof *e.key, "a finer mesh", &e.key));
    TRY(memory_alloc(e.mask + 1, sizeof *e.middle, "a finer mesh", &e.middle));
    TRY(memory_alloc(most, 3 * sizeof(float), "a finer mesh", &fine.vertex));
    TRY(memory_alloc(most, 3 * sizeof(float), "a finer mesh", &fine.normal));
    TRY(memory_alloc(most * (n_values + 1), sizeof(float), "a finer mesh", &fine.value));
    TRY(memory_alloc(fine.n_triangles, 3 * sizeof(uint32_t), "a finer mesh", &fine.triangle));
    memcpy(fine.vertex, m->vertex, 3 * n * sizeof(float));
    memcpy(fine.normal, m->normal, 3 * n * sizeof(float));
    for (size_t v = 0; v < n_values; v++)
        memcpy(fine.value + v * most, m->value + v * n, n * sizeof(float));
    for (size_t i = 0; i < m->n_triangles; i++) {
        const uint32_t *t = m->triangle + 3 * i;
        uint32_t mid[3];
        for (int k = 0; k < 3; k++) {
            mid[k] = middle_of(&e, t[k], t[(k + 1) % 3], &n);
            put_middle(m, n_values, t[k], t[(k + 1) % 3], mid[k], most, &fine);
        }
        const uint32_t four[12] = {t[0],   mid[0], mid[2], mid[0], t[1],   mid[1],
                                   mid[2], mid[1], t[2],   mid[0], mid[1], mid[2]};
        memcpy(fine.triangle + 12 * i, four, sizeof four);
    }
    for (size_t v = 0; v < n_values; v++)
        memmove(fine.value + v * n, fine.value + v * most, n * sizeof(float));
    fine.n_vertices = n;
    vdb_mesh_free(m);
    *m = fine;
    fine = (struct vdb_mesh){0};
done:
    free(e.key);
    free(e.middle);
    vdb_mesh_free(&fine);
    return st;
}

/* ---- displacement */

struct detail {
    const struct job *job;
    struct waves rough, warp;
    double shortest, longest, most; /* m */
};

static double chance(int64_t a, uint32_t b)
{
    return 2 * (double)random_float(random_hash((uint32_t)a, b, 77, 0)) - 1;
}

/* Beds of about this thickness, each of which stands out or recedes by a random amount. */
static double bed(double z, double thick, uint32_t use)
{
    double t = z / thick, f = t - floor(t);
    int64_t i = (int64_t)floor(t);
    /* Bedding planes are irregular. */
    double plane = 0.5 + 0.3 * chance(i, use + 50);
    return chance(i, use) + (chance(i + 1, use) - chance(i, use)) * ramp(plane - 0.09, plane + 0.09, f);
}

/* Amplitude of waves of this length: 0 for waves that the simulation resolves itself, and for waves that the mesh cannot show. */
static double wanted(const struct detail *d, double length)
{
    return ramp(1, 2, length / d->shortest) * (1 - ramp(1, 2.5, length / d->longest));
}

/* Upright joints, each a furrow in the wall that it crosses. */
static double joint(const struct detail *d, double x, double y, double turn, double apart, uint32_t use)
{
    double along = (cos(turn) * x + sin(turn) * y) / apart, i = floor(along), f = along - i,
           at = 0.5 + 0.35 * chance((int64_t)i, use), width = fmax(0.06 * apart, 0.7 * d->shortest) / apart;
    if (chance((int64_t)i, use + 1) < -0.2) /* not every joint is open */
        return 0;
    return -exp(-pow((f - at) / width, 2));
}

static double moved(const struct detail *d, const double x[3], const double n[3], double loose)
{
    double wall = 1 - ramp(0.35, 0.85, fabs(n[2])), floor_ = ramp(0.4, 0.9, n[2]), sum = 0, swing = 0,
           height = attitude_height(d->job, x, NULL);
    const double slow[3] = {x[0], x[1], 2 * x[2]};
    for (size_t i = 0; i < d->warp.n; i++)
        swing += 0.035 * d->warp.length[i] * wave_at(&d->warp, i, slow);
    double ledges = 0.6 + 0.4 * wave_at(&d->warp, 1, x);
    ledges = fmin(fmax(ledges, 0.1), 1.2);
    for (size_t i = 0; i < d->rough.n; i++) {
        double length = d->rough.length[i], share = wanted(d, length);
        if (share <= 0)
            continue;
        double noise = length * wave_at(&d->rough, i, x);
        double solid = wall * ledges * 0.16 * length * bed(height + swing, 0.62 * length, 10 * (uint32_t)i) +
                       (0.030 + 0.012 * floor_) * noise;
        sum += share * ((1 - loose) * solid + loose * 0.055 * noise);
    }
    double bend = 0.4 * wave_at(&d->warp, 1, slow), open = ramp(-0.4, 0.8, wave_at(&d->warp, 0, x));
    sum += (1 - loose) * wall * open *
           (0.30 * wanted(d, 1.2) * joint(d, x[0] + bend, x[1], 0.35, 4.3, 500) +
            0.26 * wanted(d, 1.0) * joint(d, x[0], x[1] + bend, 1.95, 3.7, 600));
    return d->most * tanh(sum / d->most);
}

/* Vertex normals, weighted by the areas of the triangles. */
static void find_normals(struct vdb_mesh *m)
{
    memset(m->normal, 0, 3 * m->n_vertices * sizeof(float));
    for (size_t i = 0; i < m->n_triangles; i++) {
        const uint32_t *t = m->triangle + 3 * i;
        const float *a = m->vertex + 3 * (size_t)t[0], *b = m->vertex + 3 * (size_t)t[1],
                    *c = m->vertex + 3 * (size_t)t[2];
        float u[3], v[3], n[3];
        for (int k = 0; k < 3; k++) {
            u[k] = b[k] - a[k];
            v[k] = c[k] - a[k];
        }
        for (int k = 0; k < 3; k++)
            n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
        for (int corner = 0; corner < 3; corner++)
            for (int k = 0; k < 3; k++)
                m->normal[3 * (size_t)t[corner] + (size_t)k] += n[k];
    }
    for (size_t i = 0; i < m->n_vertices; i++) {
        float *n = m->normal + 3 * i, length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int k = 0; k < 3; k++)
            n[k] = length > 0 ? n[k] / length : k == 2;
    }
}

status refine_mesh(const struct refine *how, struct vdb_mesh *m)
{
    status st = OK;
    struct detail d = {.job = how->job,
                       .rough = waves_make(12.8, 0.4, 10, 2),
                       .warp = waves_make(14, 0.28, 3, 3),
                       .shortest = 2 * how->spacing,
                       .longest = 3 * how->spacing,
                       .most = 0.4 * how->spacing};
    for (int i = 0; i < how->times && 4 * m->n_triangles <= how->most; i++) {
        TRY(cut(m, how->n_values));
        d.shortest *= 0.5;
    }
    const float *loose = how->loose >= 0 ? m->value + (size_t)how->loose * m->n_vertices : NULL;
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < m->n_vertices; i++) {
        double x[3], n[3], length = 0;
        for (int k = 0; k < 3; k++) {
            x[k] = (double)m->vertex[3 * i + (size_t)k];
            n[k] = (double)m->normal[3 * i + (size_t)k];
            length += n[k] * n[k];
        }
        length = sqrt(length);
        for (int k = 0; k < 3; k++)
            n[k] /= length > 0 ? length : 1;
        double by = moved(&d, x, n, loose ? fmin(fmax((double)loose[i], 0), 1) : 0);
        for (int k = 0; k < 3; k++)
            m->vertex[3 * i + (size_t)k] += (float)(by * n[k]);
    }
    if (how->times > 0)
        find_normals(m);
done:
    return st;
}
