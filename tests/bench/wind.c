/* The air around the demo's rock: a step of 100,000 particles, its heaviest kernel beside the same in plain C, and a first
 * average that stops by its own estimate beside two flushes of the box with four and two iterations. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "bench/bench.h"
#include "gpu/primitives.h"
#include "particles/particles.h"
#include "scene/scene.h"
#include "wind/flow.h"

enum { STEPS = 12 };
static const double blows[2] = {0.8, 0.6};

static void *copy(struct gpu *gpu, struct gpu_buffer *b, size_t n)
{
    void *memory = malloc(n * gpu_buffer_item(b));
    if (!memory)
        check(fail(E_MEMORY, "no memory for %zu items", n));
    check(gpu_download(gpu, b, 0, memory, n));
    return memory;
}

/* ---- the relaxation in plain C, over the same lists; vectors of 4, as the device has them */

struct twin {
    size_t n;
    const uint32_t *list;
    const float (*of_step)[4], (*position)[4], (*push)[4];
    const float *before;
    float *after;
};

#pragma GCC push_options
#pragma GCC optimize("O3", "fast-math")
#if defined(__x86_64__)
#pragma GCC target("avx2,fma")
#endif
static __attribute__((noinline)) void relax_in_c(const struct twin *t)
{
#pragma omp parallel for schedule(dynamic, 256)
    for (size_t i = 0; i < t->n; i++) {
        const float *x = t->position[i], *own = t->push[i];
        float left = t->of_step[i][2];
        size_t n = (size_t)t->of_step[i][3];
        for (size_t s = 0; s < n; s++) {
            size_t j = t->list[(i / 32 * FLOW_NEIGHBOURS + s) * 32 + i % 32];
            const float *o = t->position[j], *push = t->push[j];
            float d[3] = {x[0] - o[0], x[1] - o[1], x[2] - o[2]};
            float r = sqrtf(fmaxf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2], 1e-12f));
            float q = r / FLOW_SUPPORT, p = fmaxf(1 - q, 0);
            float slope = (1 / 3.14159265f) * (q <= 0.5f ? 4.5f * q - 3 : -3 * p * p / r);
            left += o[3] * slope *
                    (d[0] * (own[0] - push[0]) + d[1] * (own[1] - push[1]) + d[2] * (own[2] - push[2]));
        }
        float p = t->before[i] + 0.5f * t->of_step[i][1] * left;
        t->after[i] = t->of_step[i][0] >= 0.8f ? p : fmaxf(p, 0);
    }
}
#pragma GCC pop_options

static void relax(struct gpu *gpu, const struct flow *f)
{
    struct flow_params k = {.n = f->state.n, .slots = (uint)f->slots, .full = 0.8f};
    size_t n = k.n;
    GPU_RUN(gpu, wind_flow_push, n, k, f->of_step, f->list, f->position[0], f->divergence_pressure[0],
            f->push);
    float *before = copy(gpu, f->divergence_pressure[0], n), *after = malloc(4 * n), *device = NULL;
    uint32_t *list = copy(gpu, f->list, gpu_buffer_count(f->list));
    float(*of_step)[4] = copy(gpu, f->of_step, n), (*position)[4] = copy(gpu, f->position[0], n),
    (*push)[4] = copy(gpu, f->push, n);
    struct twin twin = {
        n,      list, (const float(*)[4])of_step, (const float(*)[4])position, (const float(*)[4])push,
        before, after};
    struct row row = {.name = "wind: one relaxation of the pressure",
                      .unit = "ms",
                      .peer = "plain C, OpenMP",
                      .at_least = 0.4};
    double worst = 0, neighbours = 0;
    if (!after)
        check(fail(E_MEMORY, "no memory for %zu pressures", n));
    for (int r = 0; r < BENCH_REPEATS; r++) {
        check(gpu_upload(gpu, f->divergence_pressure[0], 0, before, n));
        double start = clock_seconds();
        GPU_RUN(gpu, wind_flow_relax, n, k, f->of_step, f->list, f->position[0], f->push,
                f->divergence_pressure[0]);
        check(gpu_wait(gpu));
        sample(&row.ours, 1e3 * (clock_seconds() - start));
        start = clock_seconds();
        relax_in_c(&twin);
        sample(&row.theirs, 1e3 * (clock_seconds() - start));
    }
    device = copy(gpu, f->divergence_pressure[0], n);
    for (size_t i = 0; i < n; i++) {
        worst = fmax(worst, fabs((double)device[i] - (double)after[i]));
        neighbours += (double)of_step[i][3];
    }
    print_row(&row);
    printf("    %.1f neighbours each; the two differ by %.1g\n", neighbours / (double)n, worst);
    void *memory[] = {before, after, device, list, of_step, position, push};
    for (size_t i = 0; i < sizeof memory / sizeof *memory; i++)
        free(memory[i]);
}

struct bench {
    struct gpu *gpu;
    struct gpu_work *work;
    struct job *job;
    struct particles particles;
    struct flow flow;
};

static void open_air(struct bench *b, const char *spacing, const char *density, const char *divergence)
{
    const char *sets[] = {"wind.flow.solver=sph", spacing, density, divergence};
    struct rock rock;
    double change;
    int voxels[3];
    *b = (struct bench){0};
    check(job_load("jobs/demo.yaml", sets, 4, &b->job));
    check(gpu_create(&(struct gpu_options){.device = "auto"}, &b->gpu));
    check(scene_voxels(b->job, voxels));
    check(scene_sample(b->job, &rock));
    check(gpu_work_create(b->gpu, (size_t)voxels[0] * (size_t)voxels[1] * (size_t)voxels[2] + 2, &b->work));
    check(particles_create(b->gpu, b->work, &rock, STATE, voxels, b->job->domain.spacing_m, &b->particles));
    check(particles_surface(b->gpu, b->work, &b->particles));
    check(flow_create(b->gpu, b->job, voxels, &b->flow));
    check(flow_change(b->gpu, &b->flow, &b->particles, &change));
    rock_free(&rock);
}

static void close_air(struct bench *b)
{
    flow_destroy(b->gpu, &b->flow);
    particles_destroy(b->gpu, &b->particles);
    gpu_work_destroy(b->gpu, &b->work);
    gpu_destroy(&b->gpu);
    job_destroy(&b->job);
}

/* CPU s of a run after one step that compiles; its kernels are counted from there. */
static double first_average(const char *density, const char *divergence, double settled, int *steps,
                            double *error)
{
    struct bench b;
    open_air(&b, "wind.flow.spacing_m=4", density, divergence);
    check(flow_run(b.gpu, &b.flow, &b.particles, blows, 4, 0));
    b.flow.state = (struct flow_state){0};
    double start = clock_cpu_seconds();
    check(flow_run(b.gpu, &b.flow, &b.particles, blows, 2 * flow_flush(&b.flow, blows), settled));
    *steps = b.flow.report.steps;
    *error = b.flow.report.unsettled;
    start = clock_cpu_seconds() - start;
    close_air(&b);
    return start;
}

int main(void)
{
    struct bench b;
    struct row step = {.name = "wind: a step of 100,000 air particles", .unit = "ms"},
               average = {.name = "wind: a first average",
                          .unit = "CPU s",
                          .peer = "two flushes of the box",
                          .at_least = 5};
    double error[2];
    int steps[2];
    open_air(&b, "wind.flow.spacing_m=1.8", "seed=1", "seed=1");
    struct flow *flow = &b.flow;
    check(
        flow_run(b.gpu, flow, &b.particles, blows, 4, 0)); /* compiles, and takes more iterations at first */
    gpu_times_reset(b.gpu);
    for (int r = 0; r < BENCH_REPEATS; r++) {
        const double start = clock_seconds();
        check(flow_run(b.gpu, flow, &b.particles, blows, STEPS, 0));
        sample(&step.ours, 1e3 * (clock_seconds() - start) / STEPS * 1e5 / (double)flow->state.n);
    }
    print_row(&step);
    printf("    %u particles, %d + %d iterations\n", (unsigned)flow->state.n, flow->divergence_iterations,
           flow->density_iterations);
    for (int k = 0; k < KERNELS; k++) {
        const struct gpu_time *t = gpu_kernel_time(b.gpu, (enum gpu_kernel)k);
        if (t->ns > BENCH_REPEATS * STEPS * 1000000ULL)
            printf("    %-24s %7.1f ms a step in %4.1f dispatches\n", t->name,
                   1e-6 * (double)t->ns / (BENCH_REPEATS * STEPS),
                   (double)t->dispatches / (BENCH_REPEATS * STEPS));
    }
    relax(b.gpu, flow);
    close_air(&b);
    average.theirs = once(first_average("wind.flow.density_iterations=4", "wind.flow.divergence_iterations=2",
                                        0, &steps[0], &error[0]));
    average.ours = once(first_average("seed=1", "seed=1", 0.05, &steps[1], &error[1]));
    print_row(&average);
    printf("    %d steps, settled to %.3f; the flushes %d steps, %.3f\n", steps[1], error[1], steps[0],
           error[0]);
    return 0;
}
