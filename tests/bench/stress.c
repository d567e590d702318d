/* Cold solves of the stress of three shapes: iterations and seconds until the 95th percentile of T's error is a thousandth of
 * T's own 95th percentile, by multigrid, by Jacobi's diagonal and by multigrid in plain C. `stress HOODOO CELLS` takes CELLS
 * across the domain instead of 32 and 64. With BENCH_FOLDER set, the system of the demo at 64 is left there for
 * peers/algebraic.py. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench.h"
#include "stress/elastic.h"
#include "tests/ref/multigrid_ref.h"
#include "tests/ref/stress_dense.h"

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

/* A particle in every voxel inside. */
static struct rock rock_of(double (*outside)(const double x[3]), int voxels, double h)
{
    struct rock rock;
    check(rock_alloc(&rock, (size_t)voxels * (size_t)voxels * (size_t)voxels, STATE));
    rock.n = 0;
    for (int v = 0; v < voxels * voxels * voxels; v++) {
        const double x[3] = {(v % voxels + 0.5) * h, (v / voxels % voxels + 0.5) * h,
                             (v / voxels / voxels + 0.5) * h};
        if (outside(x) >= 0)
            continue;
        for (size_t a = 0; a < 3; a++)
            rock.P[4 * rock.n + a] = (float)x[a];
        rock.id[rock.n] = (uint32_t)rock.n;
        rock.viability[rock.n++] = 1;
    }
    return rock;
}

/* ---- solving */

struct bench {
    struct gpu *gpu;
    struct gpu_work *work;
    struct elastic e;
    struct particles p;
    size_t n_cells;
    float *stress, *tight; /* [cells][4] */
    double p95;
};

/* From nothing; the seconds it took. */
static double solve(struct bench *b, bool multigrid, int iterations, double tolerance, float *stress)
{
    struct elastic *e = &b->e;
    e->options.multigrid = multigrid;
    e->options.max_iterations = iterations;
    e->options.tolerance = tolerance;
    gpu_fill(b->gpu, e->u, 0);
    check(gpu_wait(b->gpu));
    double start = clock_seconds();
    check(elastic_solve(b->gpu, b->work, e));
    check(gpu_wait(b->gpu));
    start = clock_seconds() - start;
    elastic_recover(b->gpu, e, &b->p);
    check(dense_download(b->gpu, &e->lattice, e->normal_stress, false, stress));
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
    size_t n = 0, cells = b->n_cells;
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

/* Writes the system of equations and our solution for other solvers: the cells, the weight of a full one (N), the element
 * matrix (double [24][24]), the cells' fill (float), the nodes' displacement (float [4]). */
static void export_system(struct bench *b, const struct elastic_grid *g, const float *fill, double weight)
{
    double K[24][24];
    char path[4096];
    const size_t nodes = dense_nodes(g->cells);
    float *u = need(nodes, 16);
    snprintf(path, sizeof path, "%s/system", getenv("BENCH_FOLDER"));
    FILE *f = fopen(path, "w");
    if (!f)
        check(fail(E_OUTPUT, "%s cannot be written", path));
    check(dense_download(b->gpu, &b->e.lattice, b->e.u, true, u));
    elastic_ref_element(g, K);
    fprintf(f, "%d %d %d %.17g\n", g->cells[0], g->cells[1], g->cells[2], weight);
    fwrite(K, sizeof K, 1, f);
    fwrite(fill, sizeof *fill, b->n_cells, f);
    fwrite(u, 16, nodes, f);
    if (fclose(f) != 0)
        check(fail(E_OUTPUT, "%s cannot be written", path));
    free(u);
}

static void compare(int shape, int cells)
{
    struct bench b = {0};
    const int voxels[3] = {2 * cells, 2 * cells, 2 * cells};
    const struct elastic_options options = {.lambda = 12e9, .mu = 15e9, .density = 2300, .gravity = 9.81};
    check(gpu_create(&(struct gpu_options){.device = "auto"}, &b.gpu));
    check(elastic_create(b.gpu, voxels, 32.0 / cells, &options, &b.e));
    check(gpu_work_create(b.gpu, 8 * (size_t)cells * (size_t)cells * (size_t)cells + 2, &b.work));
    struct rock rock = rock_of(shapes[shape].outside, 2 * cells, 32.0 / cells);
    check(particles_create(b.gpu, b.work, &rock, STATE, voxels, 32.0 / cells, &b.p));
    check(elastic_assemble(b.gpu, b.work, &b.e, &b.p));
    const int *c = b.e.lattice.cells;
    const struct elastic_grid g = {{c[0], c[1], c[2]}, 12e9, 15e9, b.e.dx};
    const double weight = options.density * options.gravity * pow(b.e.dx, 3);
    b.n_cells = dense_cells(c);
    float *fill = need(b.n_cells, sizeof *fill), *u = need(dense_nodes(c), 16);
    check(dense_download(b.gpu, &b.e.lattice, b.e.lattice.fill, false, fill));
    b.stress = need(b.n_cells, 16);
    b.tight = need(b.n_cells, 16);
    solve(&b, true, 200, 1e-5, b.tight); /* compiles its kernels, too */
    b.p95 = p95(&b, b.tight, NULL);
    double seconds, taken[1024];
    const int cycles = fewest(&b, true, 1, &seconds), steps = fewest(&b, false, 16, &seconds);
    struct multigrid_ref *ref = multigrid_ref_create(&g, fill);
    if (!ref)
        check(fail(E_MEMORY, "no memory for the multigrid in plain C"));
    char name[4][96];
    snprintf(name[0], sizeof name[0], "stress: %s at %d^3 cells, cold", shapes[shape].name, cells);
    snprintf(name[1], sizeof name[1], "stress: %s at %d^3 cells, iterations", shapes[shape].name, cells);
    snprintf(name[2], sizeof name[2], "stress: %s at %d^3 cells, memory", shapes[shape].name, cells);
    struct row jacobi = {.name = name[0], .unit = "s", .peer = "Jacobi", .at_least = cells < 128 ? 0 : 4};
    struct row plain = {
        .name = name[0], .unit = "s", .peer = "plain C multigrid, OpenMP", .at_least = cells < 64 ? 0 : 0.7};
    for (int r = 0; r < 3; r++) {
        sample(&jacobi.theirs, solve(&b, false, steps, 1e-12, b.stress));
        const double start = clock_seconds();
        multigrid_ref_solve(ref, weight, cycles < 1024 ? cycles : 1024, taken, u);
        sample(&plain.theirs, clock_seconds() - start);
        sample(&jacobi.ours, solve(&b, true, cycles, 1e-12, b.stress));
    }
    plain.ours = jacobi.ours;
    print_row(&jacobi);
    print_row(&plain);
    print_row(&(struct row){.name = name[1],
                            .unit = "",
                            .ours = once(cycles),
                            .peer = "Jacobi",
                            .theirs = once(steps),
                            .at_most = 15});
    print_row(&(struct row){.name = name[2],
                            .unit = "MB",
                            .ours = once((double)stress_taken(&b.e, true) / 1e6),
                            .peer = "Jacobi",
                            .theirs = once((double)stress_taken(&b.e, false) / 1e6),
                            .at_least = 1 / 1.35});
    if (shape == 0 && cells == 64 && getenv("BENCH_FOLDER"))
        export_system(&b, &g, fill, weight);
    multigrid_ref_destroy(ref);
    gpu_work_destroy(b.gpu, &b.work);
    elastic_destroy(b.gpu, &b.e);
    particles_destroy(b.gpu, &b.p);
    gpu_destroy(&b.gpu);
    rock_free(&rock);
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
    for (int s = 0; s < 3; s++)
        for (int n = 0; n < (argc > 2 ? 1 : 2); n++)
            compare(s, argc > 2 ? one[0] : all[n]);
    return 0;
}
