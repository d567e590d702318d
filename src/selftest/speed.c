/* Speed: bandwidth of kernels that mostly read and write, the cost of a dispatch and of a wait for the device, and frames of the demo at
 * spacings as fine as time and memory allow. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "gpu/primitives.h"
#include "run/memory.h"
#include "selftest/selftest.h"

/* ---- streams */

/* Words to transfer: more than the caches of a GPU hold; on a CPU, a number that takes little time. */
enum { GPU_WORDS = 1 << 26, CPU_WORDS = 1 << 22, REPEATS = 5, PASSES = 4 };

struct stream {
    const char *name;
    double bytes; /* bytes moved per item */
};
static const struct stream streams[] = {
    {"copy", 8}, {"gather in order", 12}, {"gather at random", 12}, {"sum", 4}, {"scan", 12}};
enum { COPY, GATHER, GATHER_RANDOM, SUM, SCAN };

struct streams {
    struct gpu *gpu;
    struct gpu_work *work;
    struct gpu_buffer *order, *from, *to, *scalars;
    size_t n; /* a power of two */
};

static status streams_make(struct selftest *t, struct streams *s)
{
    status st = OK;
    TRY(gpu_create(&(struct gpu_options){.device = t->device}, &s->gpu));
    s->n = gpu_info(s->gpu)->is_cpu ? CPU_WORDS : GPU_WORDS;
    while (s->n > 1 << 16 && 16 * s->n > gpu_memory_free(s->gpu) / 4)
        s->n /= 2;
    TRY(gpu_work_create(s->gpu, s->n, &s->work));
    TRY(gpu_buffer_create(s->gpu, "selftest", s->n, 4, &s->order));
    TRY(gpu_buffer_create(s->gpu, "selftest", s->n, 4, &s->from));
    TRY(gpu_buffer_create(s->gpu, "selftest", s->n, 4, &s->to));
    TRY(gpu_buffer_create(s->gpu, "selftest", 8, 4, &s->scalars));
done:
    return st;
}

static void streams_free(struct streams *s)
{
    if (!s->gpu)
        return;
    struct gpu_buffer **all[] = {&s->order, &s->from, &s->to, &s->scalars};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        gpu_buffer_destroy(s->gpu, all[i]);
    gpu_work_destroy(s->gpu, &s->work);
    gpu_destroy(&s->gpu);
}

/* A permutation in irregular order: the number of items is a power of two and the factor is odd. */
static status shuffle(struct streams *s)
{
    status st = OK;
    uint32_t *order = NULL;
    TRY(memory_alloc(s->n, sizeof *order, "an order", &order));
    for (size_t i = 0; i < s->n; i++)
        order[i] = (uint32_t)(i * 2654435761u & (s->n - 1));
    TRY(gpu_upload(s->gpu, s->order, 0, order, s->n));
done:
    free(order);
    return st;
}

static void pass(struct streams *s, int which)
{
    switch (which) {
    case COPY:
        gpu_copy(s->gpu, s->to, s->from, s->n);
        break;
    case SUM:
        gpu_sum(s->gpu, s->work, s->from, s->n, s->scalars, 0);
        break;
    case SCAN:
        gpu_scan(s->gpu, s->work, s->to, s->n);
        break;
    default:
        gpu_gather(s->gpu, s->order, s->from, s->to, s->n);
    }
}

static status one_stream(struct selftest *t, const void *what, struct row *row)
{
    status st = OK;
    struct streams s = {0};
    const int which = (int)((const struct stream *)what - streams);
    double least = INFINITY;
    TRY(streams_make(t, &s));
    const struct count_params k = {(uint32_t)s.n};
    GPU_RUN(s.gpu, gpu_iota, s.n, k, s.order);
    if (which == GATHER_RANDOM)
        TRY(shuffle(&s));
    for (int i = 0; i <= REPEATS; i++) { /* the first dispatch compiles the kernel */
        TRY(gpu_wait(s.gpu));
        const double start = clock_seconds();
        for (int p = 0; p < PASSES; p++) /* so many that the overhead of starting them is small */
            pass(&s, which);
        TRY(gpu_wait(s.gpu));
        least = i > 0 ? fmin(least, (clock_seconds() - start) / PASSES) : least;
    }
    const double rate = streams[which].bytes * (double)s.n / least;
    row_found(row, "%.1f GB/s, %.0f million words", rate / 1e9, (double)s.n / 1e6);
    row_value(row, "bytes_a_second", rate);
    row_value(row, "words", (double)s.n);
    row_value(row, "pass_seconds", least);
done:
    streams_free(&s);
    return st;
}

/* ---- dispatches */

/* Time of the host to record a dispatch. They are fewer than are submitted at once. */
static double record_seconds(struct streams *s)
{
    enum { DISPATCHES = 90 };
    const struct count_params k = {64};
    const double start = clock_seconds();
    for (int i = 0; i < DISPATCHES; i += 2) {
        GPU_RUN(s->gpu, gpu_gather_u, k.n, k, s->order, s->from, s->to);
        GPU_RUN(s->gpu, gpu_gather_u, k.n, k, s->order, s->to, s->from);
    }
    return (clock_seconds() - start) / DISPATCHES;
}

static status dispatches(struct selftest *t, const void *what, struct row *row)
{
    status st = OK;
    struct streams s = {0};
    double record = INFINITY, look = INFINITY;
    uint32_t word;
    (void)what;
    TRY(streams_make(t, &s));
    for (int i = 0; i < 10 * REPEATS; i++) {
        record = fmin(record, record_seconds(&s));
        TRY(gpu_wait(s.gpu));
        const double start = clock_seconds();
        gpu_fill(s.gpu, s.scalars, 0);
        TRY(gpu_download(s.gpu, s.scalars, 0, &word, 1));
        look = fmin(look, clock_seconds() - start);
    }
    row_found(row, "%.2f us to record, %.0f us for a wait", 1e6 * record, 1e6 * look);
    row_value(row, "record_seconds", record);
    row_value(row, "wait_seconds", look);
done:
    streams_free(&s);
    return st;
}

/* ---- the demo */

enum { FRAMES = 3 };

static void keep_pace(struct findings *r, const struct pace *p)
{
    if (r->n_paces == PACES_MOST)
        memmove(r->pace, r->pace + 1, --r->n_paces * sizeof *r->pace);
    r->pace[r->n_paces++] = *p;
}

static status measure(struct selftest *t, struct gpu *gpu, const struct job *job, struct pace *p)
{
    status st = OK;
    struct model *model = NULL;
    const struct gpu_time *times;
    double start = clock_seconds();
    TRY(model_create(gpu, job, NULL, &model));
    TRY(model_step(model)); /* compiles */
    TRY(gpu_wait(gpu));
    p->start_seconds = clock_seconds() - start;
    gpu_times_reset(gpu);
    start = clock_seconds();
    for (int i = 0; i < FRAMES; i++) {
        TRY(selftest_stop(t));
        TRY(model_step(model));
    }
    TRY(gpu_wait(gpu));
    p->frame_seconds = (clock_seconds() - start) / FRAMES;
    const size_t n = gpu_stage_times(gpu, &times);
    for (size_t i = 0; i < n && i < STAGES_MOST; i++) {
        p->stage[p->n_stages++] =
            (struct gpu_time){times[i].name, times[i].ns / FRAMES, times[i].dispatches / FRAMES};
        p->dispatches += (double)times[i].dispatches / FRAMES;
    }
done:
    model_destroy(&model);
    return st;
}

static status demo_at(struct selftest *t, const void *what, struct row *row)
{
    status st = OK;
    char set[64];
    const char *const sets[] = {set};
    struct pace p = {.spacing_m = *(const double *)what};
    struct job *job = NULL;
    struct gpu *gpu = NULL;
    struct model_estimate estimate;
    snprintf(set, sizeof set, "domain.spacing_m=%.10g", p.spacing_m);
    TRY(selftest_load(t, t->demo, sets, 1, &job));
    TRY(gpu_create(&(struct gpu_options){.device = t->device}, &gpu));
    TRY(model_estimate(job, &estimate));
    p.n_particles = estimate.n_particles;
    TRY(measure(t, gpu, job, &p));
    row_found(row, "%.1f ms a frame, %zu particles", 1e3 * p.frame_seconds, p.n_particles);
    row_value(row, "frame_seconds", p.frame_seconds);
    row_value(row, "particles", (double)p.n_particles);
    row_value(row, "dispatches", p.dispatches);
    keep_pace(&t->findings, &p);
done:
    gpu_destroy(&gpu);
    job_destroy(&job);
    return st;
}

/* E_MEMORY: the demo does not fit at this spacing. */
static status demo_fits(struct selftest *t, double spacing)
{
    status st = OK;
    char set[64];
    const char *const sets[] = {set};
    struct job *job = NULL;
    struct gpu *gpu = NULL;
    struct model_estimate estimate;
    snprintf(set, sizeof set, "domain.spacing_m=%.10g", spacing);
    TRY(selftest_load(t, t->demo, sets, 1, &job));
    TRY(gpu_create(&(struct gpu_options){.device = t->device}, &gpu));
    TRY(run_memory_check(gpu, job, &estimate));
done:
    gpu_destroy(&gpu);
    job_destroy(&job);
    return st;
}

/* The spacing is halved as long as the next one is expected to be within the time. Starting and compiling take about as long as before, frames
 * 8.5 times as long. */
static status demo(struct selftest *t)
{
    status st = OK;
    const double patience = t->quick ? 15 : 150, begun = clock_seconds();
    const struct findings *r = &t->findings;
    for (double spacing = 4; st == OK; spacing /= 2) {
        char name[32];
        const double start = clock_seconds();
        snprintf(name, sizeof name, "demo at %.4g m", spacing);
        TRY(selftest_do(t, "speed", name, demo_at, &spacing));
        const double now = clock_seconds();
        if (!r->row[r->n_rows - 1].ok)
            break;
        const double next = now - start + 12 * (FRAMES + 1) * r->pace[r->n_paces - 1].frame_seconds;
        if (now - begun + next > patience)
            break;
        st = demo_fits(t, spacing / 2);
    }
    if (st == E_MEMORY)
        st = OK;
done:
    return st;
}

status selftest_speed(struct selftest *t)
{
    status st = OK;
    for (size_t i = 0; i < sizeof streams / sizeof *streams; i++)
        TRY(selftest_do(t, "speed", streams[i].name, one_stream, &streams[i]));
    TRY(selftest_do(t, "speed", "dispatch", dispatches, NULL));
    TRY(demo(t));
done:
    return st;
}
