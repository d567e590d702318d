/* How soon the stress of three shapes is right, from nothing: iterations and seconds until the 95th percentile of T's
 * error is a thousandth of T's own, by multigrid, by Jacobi's diagonal and by plain C, in one run. `stress HOODOO CELLS`
 * takes that many cells across instead of 32 and 64. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/version.h"
#include "bench/help.h"
#include "stress/elastic.h"
#include "tests/ref/multigrid_ref.h"

#define GOAL 1e-3

/* ---- the shapes, in a cube of 64 m */

static double box(const double x[3], double x0, double y0, double z0, double x1, double y1, double z1)
{
    return fmax(fmax(fmax(x0 - x[0], x[0] - x1), fmax(y0 - x[1], x[1] - y1)), fmax(z0 - x[2], x[2] - z1));
}

/* The demo's block on two supports. */
static double demo(const double x[3])
{
    return fmin(box(x, 6, 4, 6, 58, 20, 46),
                fmin(box(x, 6, 4, -9, 18, 20, 6.5), box(x, 46, 4, -9, 58, 20, 6.5)));
}

static double mushroom(const double x[3])
{
    double r = hypot(x[0] - 32, x[1] - 32);
    return fmin(fmax(r - 9, x[2] - 44), fmax(r - 30, fmax(43 - x[2], x[2] - 62)));
}

/* 64 pillars with caps on joint ground. */
static double pillars(const double x[3])
{
    int n = (int)(x[0] / 8) + 8 * (int)(x[1] / 8);
    double r = hypot(fmod(x[0], 8) - 4, fmod(x[1], 8) - 4), top = 16 + (n * 37 % 64) / 4.0;
    return fmin(x[2] - 6, fmin(fmax(r - 1.8, x[2] - top), fmax(r - 2.6, fmax(top - 3 - x[2], x[2] - top))));
}

static const struct {
    const char *name;
    double (*outside)(const double x[3]);
} shapes[] = {{"demo", demo}, {"mushroom", mushroom}, {"64 pillars", pillars}};

static float *fill_of(double (*outside)(const double x[3]), const struct elastic_grid *g)
{
    float *fill = need(elastic_ref_cell(g, 0, 0, g->cells[2]), sizeof *fill);
#pragma omp parallel for schedule(dynamic, 1)
    for (int k = 1; k < g->cells[2] - 1; k++)
        for (int j = 1; j < g->cells[1] - 1; j++)
            for (int i = 1; i < g->cells[0] - 1; i++) {
                int inside = 0;
                for (int e = 0; e < 8; e++) {
                    double x[3] = {(i - 0.75 + 0.5 * (e & 1)) * g->dx,
                                   (j - 0.75 + 0.5 * (e >> 1 & 1)) * g->dx,
                                   (k - 0.75 + 0.5 * (e >> 2)) * g->dx};
                    inside += outside(x) < 0;
                }
                fill[elastic_ref_cell(g, i, j, k)] = (float)inside / 8;
            }
    return fill;
}

/* ---- solving */

struct bench {
    struct gpu *gpu;
    struct gpu_work *work;
    struct elastic e;
    float *stress, *tight; /* [cells][4] */
    double p95;
};

static void set_shape(struct bench *b, const float *fill)
{
    struct elastic *e = &b->e;
    struct stress_params k = {.n = (uint)elastic_nodes(e),
                              .cx = (uint)e->cells[0],
                              .cy = (uint)e->cells[1],
                              .cz = (uint)e->cells[2]};
    check(gpu_upload(b->gpu, e->fill, 0, fill, elastic_cells(e)));
    GPU_RUN(b->gpu, stress_active, k.n, k, e->fill, e->flags);
    check(gpu_compact(b->gpu, b->work, e->flags, e->place, e->list, elastic_nodes(e), &e->n_active));
}

/* From nothing; the seconds it took. */
static double solve(struct bench *b, bool multigrid, int iterations, double tolerance, float *stress)
{
    struct elastic *e = &b->e;
    struct stress_params k = {.n = (uint)elastic_cells(e),
                              .cx = (uint)e->cells[0],
                              .cy = (uint)e->cells[1],
                              .cz = (uint)e->cells[2],
                              .lambda = 12e9f,
                              .mu = 15e9f,
                              .dx = (float)e->dx};
    e->options.multigrid = multigrid;
    e->options.max_iterations = iterations;
    e->options.tolerance = tolerance;
    gpu_fill(b->gpu, e->u, 0);
    check(gpu_wait(b->gpu));
    double start = clock_seconds();
    check(elastic_solve(b->gpu, b->work, e));
    check(gpu_wait(b->gpu));
    start = clock_seconds() - start;
    GPU_RUN(b->gpu, stress_recover, k.n, k, e->u, e->fill, e->normal_stress, e->shear_stress);
    check(gpu_download(b->gpu, e->normal_stress, 0, stress, elastic_cells(e)));
    return start;
}

static int ascending(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* The 95th percentile of |T - other's| over the rock. */
static double p95(const struct bench *b, const float *stress, const float *other)
{
    size_t n = 0, cells = elastic_cells(&b->e);
    float *x = need(cells, sizeof *x);
    for (size_t c = 0; c < cells; c++)
        if (b->tight[4 * c + 3] != 0)
            x[n++] = fabsf(stress[4 * c + 3] - (other ? other[4 * c + 3] : 0));
    qsort(x, n, sizeof *x, ascending);
    double result = (double)x[n * 95 / 100];
    free(x);
    return result;
}

/* The fewest iterations, in steps of `step`, whose error is within the goal; their seconds. */
static int fewest(struct bench *b, bool multigrid, int step, double *seconds)
{
    int low = 0, high = step;
    while (*seconds = solve(b, multigrid, high, 1e-12, b->stress),
           p95(b, b->stress, b->tight) > GOAL * b->p95 && high < 20000) {
        low = high;
        high *= 2;
    }
    while (high - low > step && high - low > high / 16) {
        int middle = (low + high) / 2 / step * step;
        double took = solve(b, multigrid, middle, 1e-12, b->stress);
        if (p95(b, b->stress, b->tight) > GOAL * b->p95)
            low = middle;
        else {
            high = middle;
            *seconds = took;
        }
    }
    return high;
}

static void compare(int shape, int cells)
{
    struct bench b = {0};
    const int voxels[3] = {2 * cells, 2 * cells, 2 * cells};
    const struct elastic_options options = {.lambda = 12e9, .mu = 15e9, .density = 2300, .gravity = 9.81};
    check(gpu_create(&(struct gpu_options){.device = "auto"}, &b.gpu));
    check(elastic_create(b.gpu, voxels, 32.0 / cells, &options, &b.e));
    check(gpu_work_create(b.gpu, elastic_nodes(&b.e) + 2, &b.work));
    const struct elastic_grid g = {{b.e.cells[0], b.e.cells[1], b.e.cells[2]}, 12e9, 15e9, b.e.dx};
    float *fill = fill_of(shapes[shape].outside, &g), *u = need(elastic_nodes(&b.e), 16);
    b.stress = need(elastic_cells(&b.e), 16);
    b.tight = need(elastic_cells(&b.e), 16);
    set_shape(&b, fill);
    solve(&b, true, 200, 1e-5, b.tight); /* compiles its kernels, too */
    b.p95 = p95(&b, b.tight, NULL);
    double by_cycles, by_jacobi, taken[1024], start;
    int cycles = fewest(&b, true, 1, &by_cycles);
    int steps = fewest(&b, false, 16, &by_jacobi);
    struct multigrid_ref *ref = multigrid_ref_create(&g, fill);
    if (!ref)
        check(fail(E_MEMORY, "no memory for plain C"));
    start = clock_seconds();
    multigrid_ref_solve(ref, 2300 * 9.81 * pow(b.e.dx, 3), cycles < 1024 ? cycles : 1024, taken, u);
    start = clock_seconds() - start;
    printf("%-10s %4d^3 cells, %8zu nodes: multigrid %3d iterations %7.2f s; Jacobi %5d %7.2f s, ratio %5.1f "
           "(goal "
           "4); plain C multigrid %6.2f s, ratio %4.2f (goal 0.7); memory %.2f of Jacobi's (goal 1.35)\n",
           shapes[shape].name, cells, b.e.n_active, cycles, by_cycles, steps, by_jacobi,
           by_jacobi / by_cycles, start, start / by_cycles,
           (double)elastic_bytes(voxels) / (double)(elastic_bytes(voxels) - multigrid_bytes(b.e.cells)));
    fflush(stdout);
    multigrid_ref_destroy(ref);
    gpu_work_destroy(b.gpu, &b.work);
    elastic_destroy(b.gpu, &b.e);
    gpu_destroy(&b.gpu);
    free(fill);
    free(u);
    free(b.stress);
    free(b.tight);
}

int main(int argc, char **argv)
{
    const int all[] = {32, 64}, one[] = {argc > 2 ? atoi(argv[2]) : 0};
    if (argc > 3 || (argc > 2 && (one[0] < 8 || one[0] > 512)))
        check(fail(E_USAGE, "usage: stress [HOODOO [CELLS]]"));
    printf("hoodoo %s, commit %s: T within %g at its 95th percentile, from nothing\n", hoodoo_version,
           hoodoo_commit, GOAL);
    for (int s = 0; s < 3; s++)
        for (int n = 0; n < (argc > 2 ? 1 : 2); n++)
            compare(s, argc > 2 ? one[0] : all[n]);
    return 0;
}
