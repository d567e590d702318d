/* Goblins beside the paper's own times (Beardall et al. 2007, section 6, a 2.4 GHz Core 2): a cube of a
 * million voxels for bubbles of radius 1 to 8, and a column of ten million weathered to nothing.
 *
 *   goblins [cube|column]
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "bench/bench.h"
#include "scene/scene.h"
#include "voxels/voxels.h"

/* A block of n voxels that fills its domain, bubbles of so many voxels. */
static struct job *block(const int n[3], int radius)
{
    char path[] = "/tmp/hoodoo-bench.XXXXXX";
    struct job *job = NULL;
    FILE *f = fdopen(mkstemp(path), "w");
    fprintf(f,
            "hoodoo: 1\nname: bench\nmodel: goblins\nframes: 1-2\n"
            "domain: {size_m: [%d, %d, %d], spacing_m: 1}\n"
            "scene: {box: {min_m: [0, 0, 0], max_m: [%d, %d, %d]}}\n"
            "strata: [{weak_m_per_kyr: 1, bubble: {radius_m: %d}}]\n"
            "noise: {amplitude: 0.2, scale_m: 20}\n",
            n[0], n[1], n[2], n[0], n[1], n[2], radius);
    fclose(f);
    check(job_load(path, NULL, 0, &job));
    unlink(path);
    return job;
}

struct result {
    double set_up, weathering; /* s */
    double worst;              /* s, the mean of cycles with at least 9/10 of the most active voxels */
    size_t cycles, most_active;
    uint64_t bytes;
};

static struct result weather(const int n[3], int radius, double quantum)
{
    struct result r = {0};
    struct job *job = block(n, radius);
    struct gpu *gpu = NULL;
    struct gpu_work *work = NULL;
    struct voxels v;
    size_t count = (size_t)n[0] * (size_t)n[1] * (size_t)n[2], rock = count, words, n_busy = 0;
    float *share = calloc(count, sizeof *share), *factor = calloc(count, sizeof *factor);
    double *seconds = calloc(100000, sizeof *seconds);
    size_t *active = calloc(100000, sizeof *active);
    check(gpu_create(&(struct gpu_options){.device = "auto"}, &gpu));
    double start = clock_seconds();
    check(scene_grid(job, false, share, factor));
    r.bytes = voxels_bytes(job, n, 0, &words);
    check(gpu_work_create(gpu, words, &work));
    check(voxels_create(gpu, work, job, n, share, factor, &v));
    check(voxels_rates(gpu, &v, job, 1));
    check(gpu_wait(gpu));
    r.set_up = clock_seconds() - start;
    while (rock > 0 && r.cycles < 100000) {
        double passed, before = clock_seconds();
        uint32_t gone;
        active[r.cycles] = v.n_active;
        check(voxels_cycle(gpu, work, &v, quantum, 1e9, &passed, &gone));
        seconds[r.cycles++] = clock_seconds() - before;
        rock -= gone;
        r.most_active = v.n_active > r.most_active ? v.n_active : r.most_active;
    }
    for (size_t i = 0; i < r.cycles; i++) {
        r.weathering += seconds[i];
        if (active[i] >= r.most_active / 10 * 9) {
            r.worst += seconds[i];
            n_busy++;
        }
    }
    r.worst /= (double)(n_busy ? n_busy : 1);
    r.bytes += gpu_buffer_count(v.list) * 4 + gpu_work_bytes(words);
    if (getenv("KERNELS"))
        for (int k = 0; k < KERNELS; k++)
            if (gpu_kernel_time(gpu, (enum gpu_kernel)k)->ns)
                printf("    %-20s %9.1f ms\n", gpu_kernel_time(gpu, (enum gpu_kernel)k)->name,
                       (double)gpu_kernel_time(gpu, (enum gpu_kernel)k)->ns / 1e6);
    voxels_destroy(gpu, &v);
    gpu_work_destroy(gpu, &work);
    gpu_destroy(&gpu);
    job_destroy(&job);
    free(share);
    free(factor);
    free(seconds);
    free(active);
    return r;
}

static void cube(double quantum)
{
    static const double paper[] = {0, 33, 0, 0, 0, 0, 0, 1891, 0}; /* ms, by radius; 0: not stated */
    const int n[3] = {100, 100, 100};
    for (int radius = 1; radius <= 8; radius++) {
        const struct result r = weather(n, radius, quantum);
        char name[80];
        snprintf(name, sizeof name, "goblins: a cycle of a million voxels, bubbles of radius %d", radius);
        struct row row = {.name = name, .unit = "ms", .ours = once(1e3 * r.worst)};
        if (paper[radius] > 0) {
            row.peer = "the paper, 2007";
            row.theirs = once(paper[radius]);
            row.at_least = 1;
        }
        print_row(&row);
        printf("    %zu cycles, %zu voxels at most in one, %.1f ms on average\n", r.cycles, r.most_active,
               1e3 * r.weathering / (double)r.cycles);
    }
}

static void column(double quantum)
{
    const int n[3] = {224, 224, 200};
    const struct result r = weather(n, 4, quantum);
    print_row(&(struct row){.name = "goblins: a column of ten million voxels weathered to nothing",
                            .unit = "s",
                            .ours = once(r.set_up + r.weathering),
                            .peer = "the paper, 2007",
                            .theirs = once(753),
                            .at_least = 1});
    print_row(&(struct row){.name = "goblins: its memory on the device",
                            .unit = "MB",
                            .ours = once((double)r.bytes / 1e6),
                            .peer = "the paper, 2007",
                            .theirs = once(793),
                            .at_least = 1});
    printf("    set-up %.1f s of it; %zu cycles, %.1f ms each, %.1f ms with the most active (%zu)\n",
           r.set_up, r.cycles, 1e3 * r.weathering / (double)r.cycles, 1e3 * r.worst, r.most_active);
}

int main(int argc, char **argv)
{
    const char *which = argc > 1 ? argv[1] : "";
    double quantum = argc > 2 ? atof(argv[2]) : 0.5;
    if (strcmp(which, "column") != 0)
        cube(quantum);
    if (strcmp(which, "cube") != 0)
        column(quantum);
    return 0;
}
