/* Routing on 128^3 cells of porous, hilly rock beside the tests' plain C (one thread, Kruskal's tree), whose receivers must be
 * the same bits; the streams on its 256^3 voxels; and routing and discharge over a plain of 1024 x 1024 columns with pits. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "bench/bench.h"
#include "tests/ref/flow_ref.h"
#include "water/water.h"

enum { VOXELS = 256, WIDE = 1024, HIGH = 10 };

/* Noise between -1 and 1, smooth over `size` voxels. */
static double smooth(double x, double y, double z, double size, uint32_t seed)
{
    double p[3] = {x / size, y / size, z / size}, sum = 0;
    int low[3];
    for (int a = 0; a < 3; a++) {
        low[a] = (int)floor(p[a]);
        p[a] -= low[a];
        p[a] = p[a] * p[a] * (3 - 2 * p[a]);
    }
    for (int s = 0; s < 8; s++) {
        uint32_t at[3];
        double weight = 1;
        for (int a = 0; a < 3; a++) {
            at[a] = (uint32_t)(low[a] + (s >> a & 1));
            weight *= s >> a & 1 ? p[a] : 1 - p[a];
        }
        sum += weight * (double)random_float(random_hash(at[0], at[1], at[2], seed));
    }
    return 2 * sum - 1;
}

static void put(struct rock *rock, size_t *n, int i, int j, int k)
{
    check(*n < rock->n ? OK : fail(E_USAGE, "the rock has more than %zu particles", rock->n));
    rock->P[4 * *n] = (float)i + 0.5f;
    rock->P[4 * *n + 1] = (float)j + 0.5f;
    rock->P[4 * *n + 2] = (float)k + 0.5f;
    rock->id[*n] = (uint32_t)*n;
    rock->viability[*n] = 0.1f + 0.9f * random_float(random_hash((uint32_t)i, (uint32_t)j, (uint32_t)k, 4));
    ++*n;
}

/* Hills with hollows in them. Deep rock has one particle a cell, the surface eight. */
static void make_hills(struct rock *rock)
{
    size_t n = 0;
    check(rock_alloc(rock, (size_t)VOXELS * VOXELS * VOXELS / 2, STATE));
    for (int k = 0; k < VOXELS; k++)
        for (int j = 0; j < VOXELS; j++)
            for (int i = 0; i < VOXELS; i++) {
                double top = 150 + 40 * smooth(i, j, 0, 80, 1) + 12 * smooth(i, j, 0, 20, 2) + 0.2 * i;
                if (k > top || (k > 20 && smooth(i, j, k, 22, 3) > 0.45))
                    continue;
                bool deep = k < top - 3 && smooth(i, j, k, 22, 3) < 0.2;
                if (!(deep && (i | j | k) & 1))
                    put(rock, &n, i, j, k);
            }
    rock->n = n;
}

/* Solid ground of WIDE x WIDE columns with pits; its heights, in voxels, are left in BENCH_FOLDER for peers/fastscape.py. */
static void make_plain(struct rock *rock)
{
    size_t n = 0;
    float *height = need((size_t)WIDE * WIDE, sizeof *height);
    check(rock_alloc(rock, (size_t)WIDE * WIDE * HIGH, STATE));
    for (int j = 0; j < WIDE; j++)
        for (int i = 0; i < WIDE; i++) {
            const double top = 5 + 2.5 * smooth(i, j, 0, 120, 1) + 1.5 * smooth(i, j, 0, 20, 2);
            for (int k = 0; k <= top; k++)
                put(rock, &n, i, j, k);
            height[(size_t)j * WIDE + (size_t)i] = (float)floor(top) + rock->viability[n - 1];
        }
    rock->n = n;
    if (getenv("BENCH_FOLDER")) {
        char path[4096];
        snprintf(path, sizeof path, "%s/heights", getenv("BENCH_FOLDER"));
        FILE *f = fopen(path, "w");
        if (!f || fwrite(height, sizeof *height, (size_t)WIDE * WIDE, f) != (size_t)WIDE * WIDE ||
            fclose(f) != 0)
            check(fail(E_OUTPUT, "%s cannot be written", path));
    }
    free(height);
}

static void time_plain(struct gpu *gpu, const struct job *job)
{
    const int n[3] = {WIDE, WIDE, HIGH};
    struct rock rock;
    struct particles p;
    struct gpu_work *work = NULL;
    struct water w;
    const struct water_routing how = {.seed = 1, .frame = 1};
    struct row row = {.name = "water: route and discharge on 1024 x 1024 columns", .unit = "ms"};
    make_plain(&rock);
    check(gpu_work_create(gpu, (size_t)WIDE * WIDE * HIGH + 2, &work));
    check(particles_create(gpu, work, &rock, STATE, n, 1, &p));
    rock_free(&rock);
    check(water_create(gpu, job, n, 1, 1, &w));
    for (int r = 0; r <= BENCH_REPEATS; r++) {
        const double start = clock_seconds();
        check(water_route(gpu, work, &w, &how, &p));
        check(water_discharge(gpu, work, &w, job, 1, &p));
        check(gpu_wait(gpu));
        if (r > 0)
            sample(&row.ours, 1e3 * (clock_seconds() - start));
    }
    print_row(&row);
    printf("    %zu spans, %zu basins\n", w.n_nodes, w.n_basins);
    water_destroy(gpu, &w);
    particles_destroy(gpu, &p);
    gpu_work_destroy(gpu, &work);
}

/* The time of each kernel since gpu_times_reset(), by repeat. */
static void kernels(struct gpu *gpu, int repeats)
{
    for (int i = 0; i < KERNELS; i++) {
        const struct gpu_time *t = gpu_kernel_time(gpu, (enum gpu_kernel)i);
        if (t->dispatches)
            printf("    %-20s %9.2f ms in %6.1f dispatches\n", t->name, 1e-6 * (double)t->ns / repeats,
                   (double)t->dispatches / repeats);
    }
}

/* Routing, discharge and streams over voxels: what a step of erosion in the rain takes. */
static void time_streams(struct gpu *gpu, struct gpu_work *work, const struct job *job, const int n[3],
                         struct particles *p)
{
    struct water w;
    struct row row = {.name = "water: route, discharge and streams on 256^3 voxels", .unit = "ms"};
    const struct water_routing how = {.seed = 1, .frame = 1};
    check(water_create(gpu, job, n, 1, 1, &w));
    for (int r = 0; r <= BENCH_REPEATS; r++) {
        if (r == 1)
            gpu_times_reset(gpu);
        const double start = clock_seconds();
        check(water_route(gpu, work, &w, &how, p));
        check(water_discharge(gpu, work, &w, job, 1, p));
        check(gpu_wait(gpu));
        if (r > 0)
            sample(&row.ours, 1e3 * (clock_seconds() - start));
    }
    print_row(&row);
    kernels(gpu, BENCH_REPEATS);
    water_destroy(gpu, &w);
}

int main(void)
{
    struct gpu *gpu = NULL;
    struct gpu_work *work = NULL;
    struct particles p;
    struct water w;
    struct rock rock;
    struct job job = {0};
    double frame = 1, year = 1;
    struct row route = {.name = "water: route on 128^3 cells", .unit = "ms"},
               cells = {.name = "water: route on 128^3 cells, with every cell's receiver",
                        .unit = "ms",
                        .peer = "plain C, one thread, Kruskal's tree",
                        .at_least = 1};
    const int n[3] = {VOXELS, VOXELS, VOXELS};
    job.rain.least_width_m = 3;
    job.rain.slope_m = 6;
    job.rain.pull_Pa = 0.12;
    job.rain.steepest = 10;
    job.rain.m_per_yr = (struct curve){.n = 1, .frame = &frame, .value = &year};
    make_hills(&rock);
    check(gpu_create(&(struct gpu_options){.device = "auto"}, &gpu));
    check(gpu_work_create(gpu, (size_t)VOXELS * VOXELS * VOXELS + 2, &work));
    check(particles_create(gpu, work, &rock, STATE, n, 1, &p));
    rock_free(&rock);
    check(particles_download(gpu, &p, STATE, &rock));
    check(water_create(gpu, &job, n, 1, 2, &w));
    struct water_routing how = {.seed = 1, .frame = 1, .unshifted = true};
    for (int r = 0; r <= BENCH_REPEATS; r++) {
        if (r == 1)
            gpu_times_reset(gpu);
        double start = clock_seconds();
        how.cells = false;
        check(water_route(gpu, work, &w, &how, &p));
        check(gpu_wait(gpu));
        if (r > 0)
            sample(&route.ours, 1e3 * (clock_seconds() - start));
        start = clock_seconds();
        how.cells = true;
        check(water_route(gpu, work, &w, &how, &p));
        check(gpu_wait(gpu));
        if (r > 0)
            sample(&cells.ours, 1e3 * (clock_seconds() - start));
    }
    kernels(gpu, 2 * BENCH_REPEATS);
    uint32_t random = water_random(&how, w.shift), *receiver = calloc(w.columns * VOXELS, 4);
    struct flow_ref f = {0};
    for (int r = 0; r < 2; r++) {
        flow_ref_free(&f);
        const double start = clock_seconds();
        f = flow_ref_route(&rock, n, 1, 2, w.shift, random, false, 0);
        sample(&cells.theirs, 1e3 * (clock_seconds() - start));
    }
    check(gpu_download(gpu, w.receiver, 0, receiver, f.n));
    print_row(&route);
    print_row(&cells);
    printf("    %zu spans, %zu basins, %s\n", w.n_nodes, w.n_basins,
           memcmp(receiver, f.receiver, f.n * 4) == 0 ? "the same bits as plain C"
                                                      : "OTHER BITS THAN PLAIN C");
    time_streams(gpu, work, &job, n, &p);
    flow_ref_free(&f);
    free(receiver);
    rock_free(&rock);
    water_destroy(gpu, &w);
    particles_destroy(gpu, &p);
    gpu_work_destroy(gpu, &work);
    time_plain(gpu, &job);
    gpu_destroy(&gpu);
    return 0;
}
