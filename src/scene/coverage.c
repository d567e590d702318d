#include "scene/coverage.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "scene/scene.h"

enum { EMPTY, FULL, MIXED }; /* MIXED + i: voxels at share[i * 64] */

struct coverage {
    size_t bricks[3];
    uint32_t *brick;
    uint8_t *share;
};

/* solid_in_box() of cell `at` of a grid of `side` voxels. Its faces may be the solid's, for no probe is on a face. */
static enum solid_share in_voxels(const struct solid *solid, double h, const double at[3], double side)
{
    double min[3], max[3];
    for (int a = 0; a < 3; a++) {
        min[a] = at[a] * side * h;
        max[a] = (at[a] + 1) * side * h;
    }
    return solid_in_box(solid, min, max);
}

/* The number of probes inside the solid; stops at `enough`. */
static unsigned count_probes(const struct solid *solid, double h, int i, int j, int k, unsigned enough)
{
    const double corner[3] = {i * h, j * h, k * h};
    const double middle[3] = {(i + 0.5) * h, (j + 0.5) * h, (k + 0.5) * h};
    double d = solid_at(solid, middle).distance;
    if (fabs(d) > 0.8661 * h) /* half the voxel's diagonal */
        return d < 0 ? enough : 0;
    enum solid_share share = in_voxels(solid, h, (const double[]){i, j, k}, 1);
    if (share != SOLID_SOME)
        return share == SOLID_ALL ? enough : 0;
    unsigned inside = 0;
    for (int p = 0; p < COVERAGE_FULL && inside < enough; p++) {
        double x[3];
        for (int a = 0; a < 3; a++)
            x[a] = corner[a] + probe(p, a) * h;
        inside += solid_at(solid, x).distance <= 0;
    }
    return inside;
}

unsigned coverage_of_voxel(const struct solid *solid, double h, int i, int j, int k)
{
    return count_probes(solid, h, i, j, k, COVERAGE_FULL);
}

bool coverage_holds_rock(const struct solid *solid, double h, int i, int j, int k)
{
    return count_probes(solid, h, i, j, k, 1) > 0;
}

static void fill_brick(const struct solid *solid, double h, const int n[3], const size_t at[3],
                       uint8_t *share)
{
    for (int v = 0; v < BRICK * BRICK * BRICK; v++) {
        int i = (int)at[0] * BRICK + v % BRICK, j = (int)at[1] * BRICK + v / BRICK % BRICK,
            k = (int)at[2] * BRICK + v / BRICK / BRICK;
        if (i < n[0] && j < n[1] && k < n[2])
            share[v] = (uint8_t)coverage_of_voxel(solid, h, i, j, k);
    }
}

static uint32_t classify(const struct solid *solid, double h, const size_t at[3])
{
    double middle[3];
    for (int a = 0; a < 3; a++)
        middle[a] = ((double)at[a] + 0.5) * BRICK * h;
    double d = solid_at(solid, middle).distance;
    if (fabs(d) >= 0.8661 * BRICK * h)
        return d < 0 ? FULL : EMPTY;
    const double brick[3] = {(double)at[0], (double)at[1], (double)at[2]};
    enum solid_share share = in_voxels(solid, h, brick, BRICK);
    return share == SOLID_SOME ? MIXED : share == SOLID_ALL ? FULL : EMPTY;
}

status coverage_create(const struct solid *solid, const int n[3], double h, struct coverage **out)
{
    status st = OK;
    struct coverage *c = NULL;
    uint32_t n_mixed = 0;
    TRY(memory_alloc(1, sizeof *c, "the scene's voxels", &c));
    for (int a = 0; a < 3; a++)
        c->bricks[a] = ((size_t)n[a] + BRICK - 1) / BRICK;
    const size_t row = c->bricks[0], slab = row * c->bricks[1], n_bricks = slab * c->bricks[2];
    TRY(memory_alloc(n_bricks, sizeof *c->brick, "the scene's voxels", &c->brick));
#pragma omp parallel for schedule(dynamic, 64)
    for (size_t b = 0; b < n_bricks; b++)
        c->brick[b] = classify(solid, h, (const size_t[]){b % row, b / row % c->bricks[1], b / slab});
    for (size_t b = 0; b < n_bricks; b++)
        if (c->brick[b] == MIXED)
            c->brick[b] += n_mixed++;
    TRY(memory_alloc(n_mixed, BRICK * BRICK * BRICK, "the scene's surface voxels", &c->share));
#pragma omp parallel for schedule(dynamic, 64)
    for (size_t b = 0; b < n_bricks; b++)
        if (c->brick[b] >= MIXED)
            fill_brick(solid, h, n, (const size_t[]){b % row, b / row % c->bricks[1], b / slab},
                       c->share + (size_t)(c->brick[b] - MIXED) * BRICK * BRICK * BRICK);
    *out = c;
    c = NULL;
done:
    coverage_destroy(&c);
    return st;
}

void coverage_destroy(struct coverage **coverage)
{
    if (!*coverage)
        return;
    free((*coverage)->brick);
    free((*coverage)->share);
    free(*coverage);
    *coverage = NULL;
}

unsigned coverage_at(const struct coverage *c, int i, int j, int k)
{
    size_t bi = (size_t)i / BRICK, bj = (size_t)j / BRICK, bk = (size_t)k / BRICK;
    uint32_t b = c->brick[(bk * c->bricks[1] + bj) * c->bricks[0] + bi];
    if (b < MIXED)
        return b == FULL ? COVERAGE_FULL : 0;
    size_t voxel = (((size_t)k % BRICK) * BRICK + (size_t)j % BRICK) * BRICK + (size_t)i % BRICK;
    return c->share[(size_t)(b - MIXED) * BRICK * BRICK * BRICK + voxel];
}
