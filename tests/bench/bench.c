/* The stress solver's matrix product beside plain C, and the demo's first frames with and without their files. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bench/bench.h"
#include "model/model.h"
#include "output/folder.h"
#include "run/writer.h"
#include "stress/elastic.h"
#include "tests/ref/elastic_ref.h"
#include "tests/ref/stress_dense.h"

enum { CELLS = 128, FRAMES = 8 };

/* ---- K u in plain C: rows of nodes, element by element, as the compiler vectorises it best */

#pragma GCC push_options
#pragma GCC optimize("O3", "fast-math")
#if defined(__x86_64__)
#pragma GCC target("avx2,fma")
#endif
/* One row of nodes, j and k given. */
static __attribute__((noinline)) void row_in_c(const float K[8][8][3][3], const int cells[3],
                                               const float *restrict fill, float *const u[3],
                                               float *const q[3], int j, int k)
{
    enum { WIDE = CELLS + 8 };
    size_t nx = (size_t)cells[0] + 1, ny = (size_t)cells[1] + 1;
    float sum[3][WIDE] = {{0}};
    int last = cells[0];
    for (int a = 0; a < 8; a++) {
        int ax = a & 1, ay = a >> 1 & 1, az = a >> 2;
        float f0[WIDE] = {0}, f1[WIDE] = {0}, f2[WIDE] = {0};
        for (int b = 0; b < 8; b += 2) {
            size_t at =
                ((size_t)(k - az + (b >> 2)) * ny + (size_t)(j - ay + (b >> 1 & 1))) * nx - (size_t)ax;
            const float *restrict x = u[0] + at, *restrict y = u[1] + at, *restrict z = u[2] + at;
            float l[3][3], h[3][3];
            memcpy(l, K[a][b], sizeof l);
            memcpy(h, K[a][b + 1], sizeof h);
            for (int i = 1; i < last; i++) {
                float x0 = x[i], y0 = y[i], z0 = z[i], x1 = x[i + 1], y1 = y[i + 1], z1 = z[i + 1];
                f0[i] +=
                    l[0][0] * x0 + l[0][1] * y0 + l[0][2] * z0 + h[0][0] * x1 + h[0][1] * y1 + h[0][2] * z1;
                f1[i] +=
                    l[1][0] * x0 + l[1][1] * y0 + l[1][2] * z0 + h[1][0] * x1 + h[1][1] * y1 + h[1][2] * z1;
                f2[i] +=
                    l[2][0] * x0 + l[2][1] * y0 + l[2][2] * z0 + h[2][0] * x1 + h[2][1] * y1 + h[2][2] * z1;
            }
        }
        const float *restrict share =
            fill + ((size_t)(k - az) * (size_t)cells[1] + (size_t)(j - ay)) * (size_t)cells[0] - ax;
        for (int i = 1; i < last; i++) {
            float s = share[i] > STRESS_FILL_FLOOR ? share[i] : STRESS_FILL_FLOOR;
            s = share[i] > 0 ? s : 0;
            sum[0][i] += s * f0[i];
            sum[1][i] += s * f1[i];
            sum[2][i] += s * f2[i];
        }
    }
    for (int c = 0; c < 3; c++)
        memcpy(q[c] + ((size_t)k * ny + (size_t)j) * nx + 1, sum[c] + 1, (size_t)(last - 1) * sizeof(float));
}
#pragma GCC pop_options

static void apply_in_c(const float K[8][8][3][3], const int cells[3], const float *fill, float *const u[3],
                       float *const q[3])
{
#pragma omp parallel for schedule(static)
    for (int k = 1; k < cells[2]; k++)
        for (int j = 1; j < cells[1]; j++)
            row_in_c(K, cells, fill, u, q, j, k);
}

static struct gpu_buffer *buffer(struct gpu *gpu, const void *data, size_t n, size_t item)
{
    struct gpu_buffer *b = NULL;
    check(gpu_buffer_create(gpu, "bench", n, item, &b));
    if (data)
        check(gpu_upload(gpu, b, 0, data, n));
    return b;
}

static void matvec(void)
{
    struct gpu *gpu = NULL;
    struct elastic_grid g = {{CELLS + 2, CELLS + 2, CELLS + 2}, 12e9, 15e9, 1};
    size_t n_cells = elastic_ref_cell(&g, 0, 0, g.cells[2]),
           n_nodes = elastic_ref_node(&g, 0, 0, g.cells[2] + 1), n = 0;
    float *fill = need(n_cells, sizeof *fill), *u = need(4 * n_nodes, sizeof *u),
          *image = need(4 * n_nodes, sizeof *image);
    uint32_t *list = need(n_nodes, sizeof *list), *place = need(n_nodes, sizeof *place);
    struct gpu_work *work = NULL;
    struct stress_lattice lattice;
    float *split[3], *result[3];
    for (int c = 0; c < 3; c++) {
        split[c] = need(n_nodes + 16, sizeof(float));
        result[c] = need(n_nodes + 16, sizeof(float));
    }
    for (int k = 1; k < g.cells[2]; k++)
        for (int j = 1; j < g.cells[1]; j++)
            for (int i = 1; i < g.cells[0]; i++) {
                if (i < g.cells[0] - 1 && j < g.cells[1] - 1 && k < g.cells[2] - 1)
                    fill[elastic_ref_cell(&g, i, j, k)] = 1;
                size_t at = elastic_ref_node(&g, i, j, k);
                place[n] = dense_place(g.cells, i, j, k);
                list[n++] = (uint32_t)at;
                for (size_t c = 0; c < 3; c++)
                    split[c][at] = u[4 * at + c] = (float)sin((double)(3 * at + c));
            }
    double K[24][24];
    float blocks[8][8][3][3];
    elastic_ref_element(&g, K);
    for (int a = 0; a < 8; a++)
        for (int b = 0; b < 8; b++)
            for (int r = 0; r < 3; r++)
                for (int c = 0; c < 3; c++)
                    blocks[a][b][r][c] = (float)K[3 * a + r][3 * b + c];

    check(gpu_create(&(struct gpu_options){.device = "auto"}, &gpu));
    check(gpu_work_create(gpu, 2 * n_nodes, &work));
    check(dense_create(gpu, work, g.cells, &lattice));
    struct gpu_buffer *d_list = buffer(gpu, place, n, 4),
                      *d_u = buffer(gpu, NULL, lattice_items(&lattice), 16),
                      *d_q = buffer(gpu, NULL, n_nodes, 16), *d_product = buffer(gpu, NULL, n_nodes, 4);
    check(dense_upload(gpu, &lattice, d_u, true, u));
    check(dense_upload(gpu, &lattice, lattice.fill, false, fill));
    struct stress_params params = {.n = (uint)n,
                                   .cx = (uint)g.cells[0],
                                   .cy = (uint)g.cells[1],
                                   .cz = (uint)g.cells[2],
                                   .lambda = (float)g.lambda,
                                   .mu = (float)g.mu,
                                   .dx = (float)g.dx};
    struct row row = {
        .name = "stress: K u on 128^3 cells", .unit = "ms", .peer = "plain C, OpenMP", .at_least = 0.4};
    for (int r = 0; r <= BENCH_REPEATS; r++) { /* the first compiles */
        double start = clock_seconds();
        GPU_RUN(gpu, stress_matvec, n, params, d_list, lattice.run, lattice.table, d_u, lattice.fill, d_q,
                d_product);
        check(gpu_wait(gpu));
        if (r > 0)
            sample(&row.ours, 1e3 * (clock_seconds() - start));
        start = clock_seconds();
        apply_in_c((const float(*)[8][3][3])blocks, g.cells, fill, split, result);
        if (r > 0)
            sample(&row.theirs, 1e3 * (clock_seconds() - start));
    }
    check(gpu_download(gpu, d_q, 0, image, n));
    double error = 0, most = 0;
    for (size_t i = 0; i < n; i++)
        for (size_t c = 0; c < 3; c++) {
            double expected = (double)result[c][list[i]];
            error = fmax(error, fabs((double)image[4 * i + c] - expected));
            most = fmax(most, fabs(expected));
        }
    print_row(&row);
    printf("    the two differ by %.1g of the largest force\n", error / most);
    struct gpu_buffer **all[] = {&d_list, &d_u, &d_q, &d_product};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        gpu_buffer_destroy(gpu, all[i]);
    lattice_destroy(gpu, &lattice);
    gpu_work_destroy(gpu, &work);
    gpu_destroy(&gpu);
    free(fill);
    free(u);
    free(image);
    free(list);
    free(place);
    for (int c = 0; c < 3; c++) {
        free(split[c]);
        free(result[c]);
    }
}

/* ---- the demo */

/* Seconds of the demo's first frames, without the start. `root`: they are written there, too. `stages`: prints the time of
 * each stage. */
static double demo(const struct job *job, const char *root, bool stages)
{
    struct gpu *gpu = NULL;
    struct model *model = NULL;
    struct writer *writer = NULL;
    struct frame frame;
    check(gpu_create(&(struct gpu_options){.device = "auto"}, &gpu));
    check(model_create(gpu, job, NULL, &model));
    check(model_output(model, &frame)); /* compiles its kernels */
    frame_free(&frame);
    check(gpu_wait(gpu));
    gpu_times_reset(gpu);
    if (root) {
        check(folder_prepare(root));
        check(writer_create(job, &(struct job_states){0}, root, false, &writer));
    }
    const double start = clock_seconds();
    for (int f = 0; f < FRAMES; f++) {
        check(model_step(model));
        check(model_output(model, &frame));
        if (writer)
            check(writer_frame(writer, &frame));
        else
            frame_free(&frame);
    }
    check(writer_finish(&writer));
    const double seconds = clock_seconds() - start;
    if (stages) {
        const struct gpu_time *times;
        size_t n = gpu_stage_times(gpu, &times);
        double sum = 0;
        for (size_t i = 0; i < n; i++)
            sum += 1e-9 * (double)times[i].ns;
        printf("the demo's first %d frames: %.2f frames/s\n", FRAMES, FRAMES / seconds);
        for (size_t i = 0; i < n; i++)
            if (times[i].ns)
                printf("    %-14s %5.1f %%   %7.1f ms a frame\n", times[i].name,
                       1e-9 * (double)times[i].ns / seconds * 100, 1e-6 * (double)times[i].ns / FRAMES);
        printf("    %-14s %5.1f %%   %7.1f ms a frame\n", "beside kernels", 100 * (1 - sum / seconds),
               1e3 * (seconds - sum) / FRAMES);
    }
    model_destroy(&model);
    gpu_destroy(&gpu);
    return seconds;
}

int main(void)
{
    struct job *job = NULL;
    char root[] = "/tmp/hoodoo-bench.XXXXXX", command[128];
    struct row simulated = {.name = "demo: its first 8 frames, simulated", .unit = "s"},
               written = {.name = "demo: its first 8 frames, simulated and written",
                          .unit = "s",
                          .peer = "the same, not written",
                          .at_least = 0.87};
    matvec();
    check(job_load("jobs/demo.yaml", NULL, 0, &job));
    if (!mkdtemp(root))
        check(fail(E_OUTPUT, "%s cannot be made", root));
    for (int r = 0; r < BENCH_REPEATS; r++) {
        sample(&simulated.ours, demo(job, NULL, r == 0));
        sample(&written.ours, demo(job, root, false));
    }
    written.theirs = simulated.ours;
    print_row(&simulated);
    print_row(&written);
    snprintf(command, sizeof command, "rm -rf '%s'", root);
    if (system(command) != 0)
        fprintf(stderr, "bench: %s could not be removed\n", root);
    job_destroy(&job);
    return 0;
}
