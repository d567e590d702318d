/* Water's streams on 256^3 voxels; and its routing on 128^3 cells of porous, hilly rock against the tests' plain C (one thread, Kruskal's tree),
 * whose result must be the same to the bit.
 *
 *   water [HOODOO]
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "base/version.h"
#include "bench/help.h"
#include "tests/ref/flow_ref.h"
#include "water/water.h"

enum { VOXELS = 256, REPEATS = 5 };

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

/* Hills with hollows in them. Deep rock has one particle a cell, the surface eight. */
static void make_rock(struct rock *rock)
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
                if ((deep && (i | j | k) & 1) || n == rock->n)
                    continue;
                rock->P[4 * n] = (float)i + 0.5f;
                rock->P[4 * n + 1] = (float)j + 0.5f;
                rock->P[4 * n + 2] = (float)k + 0.5f;
                rock->id[n] = (uint32_t)n;
                rock->viability[n] =
                    0.1f + 0.9f * random_float(random_hash((uint32_t)i, (uint32_t)j, (uint32_t)k, 4));
                n++;
            }
    rock->n = n;
}

/* Routing, discharge and streams over voxels: what a step of erosion in the rain takes. */
static void time_streams(struct gpu *gpu, struct gpu_work *work, const struct job *job, const int n[3],
                         struct particles *p, double coarse)
{
    struct water w;
    double best = INFINITY;
    const struct water_routing how = {.seed = 1, .frame = 1};
    check(water_create(gpu, job, n, 1, 1, &w));
    for (int r = 0; r <= REPEATS; r++) {
        const double start = clock_seconds();
        check(water_route(gpu, work, &w, &how, p));
        check(water_discharge(gpu, work, &w, job, 1, p));
        check(gpu_wait(gpu));
        best = r ? fmin(best, clock_seconds() - start) : best;
    }
    printf(
        "streams on %d^3 voxels, %zu spans: %.1f ms, %.1f times as long as routing alone on cells of two\n",
        VOXELS, w.n_nodes, 1e3 * best, best / coarse);
    water_destroy(gpu, &w);
}

int main(int argc, char **argv)
{
    struct gpu *gpu = NULL;
    struct gpu_work *work = NULL;
    struct particles p;
    struct water w;
    struct rock rock;
    struct job job = {0};
    double frame = 1, year = 1, device = INFINITY, all = INFINITY, plain = INFINITY;
    double all_cpu = INFINITY, plain_cpu = INFINITY;
    const int n[3] = {VOXELS, VOXELS, VOXELS};
    (void)argv;
    if (argc > 2)
        check(fail(E_USAGE, "usage: water [HOODOO]"));
    job.rain.least_width_m = 3;
    job.rain.slope_m = 6;
    job.rain.pull_Pa = 0.12;
    job.rain.steepest = 10;
    job.rain.m_per_yr = (struct curve){.n = 1, .frame = &frame, .value = &year};
    make_rock(&rock);
    check(gpu_create(&(struct gpu_options){.device = "auto"}, &gpu));
    printf("hoodoo %s, commit %s, on %s\n\n", hoodoo_version, hoodoo_commit, gpu_info(gpu)->name);
    check(gpu_work_create(gpu, (size_t)VOXELS * VOXELS * VOXELS + 2, &work));
    check(particles_create(gpu, work, &rock, STATE, n, 1, &p));
    rock_free(&rock);
    check(particles_download(gpu, &p, STATE, &rock));
    check(water_create(gpu, &job, n, 1, 2, &w));
    struct water_routing how = {.seed = 1, .frame = 1, .unshifted = true};
    for (int r = 0; r <= REPEATS; r++) {
        if (r == 1)
            gpu_times_reset(gpu);
        double start = clock_seconds();
        how.cells = false;
        check(water_route(gpu, work, &w, &how, &p));
        check(gpu_wait(gpu));
        device = r ? fmin(device, clock_seconds() - start) : device;
        start = clock_seconds();
        double start_cpu = clock_cpu_seconds();
        how.cells = true;
        check(water_route(gpu, work, &w, &how, &p));
        check(gpu_wait(gpu));
        all = r ? fmin(all, clock_seconds() - start) : all;
        all_cpu = r ? fmin(all_cpu, clock_cpu_seconds() - start_cpu) : all_cpu;
    }
    for (int i = 0; i < KERNELS; i++) {
        const struct gpu_time *t = gpu_kernel_time(gpu, (enum gpu_kernel)i);
        if (t->dispatches)
            printf("    %-20s %8.2f ms in %4.1f launches\n", t->name, 1e-6 * (double)t->ns / (2 * REPEATS),
                   (double)t->dispatches / (2 * REPEATS));
    }
    uint32_t random = water_random(&how, w.shift), *receiver = calloc(w.columns * VOXELS, 4);
    struct flow_ref f = {0};
    for (int r = 0; r < 2; r++) {
        flow_ref_free(&f);
        double start = clock_seconds(), start_cpu = clock_cpu_seconds();
        f = flow_ref_route(&rock, n, 1, 2, w.shift, random, false, 0);
        plain = fmin(plain, clock_seconds() - start);
        plain_cpu = fmin(plain_cpu, clock_cpu_seconds() - start_cpu);
    }
    check(gpu_download(gpu, w.receiver, 0, receiver, f.n));
    printf("routing on %d^3 cells, %zu spans, %zu basins: device %.1f ms (with every cell's "
           "receiver %.1f)   plain C %.1f ms   %.1f times as fast (goal 1; by CPU time of all threads %.1f)  "
           " %s\n",
           VOXELS / 2, w.n_nodes, w.n_basins, 1e3 * device, 1e3 * all, 1e3 * plain, plain / all,
           plain_cpu / all_cpu, memcmp(receiver, f.receiver, f.n * 4) == 0 ? "same bits" : "DIFFERENT");
    time_streams(gpu, work, &job, n, &p, device);
    flow_ref_free(&f);
    free(receiver);
    rock_free(&rock);
    water_destroy(gpu, &w);
    particles_destroy(gpu, &p);
    gpu_work_destroy(gpu, &work);
    gpu_destroy(&gpu);
    return 0;
}
