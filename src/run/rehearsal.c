#include "run/rehearsal.h"

#include <math.h>
#include <stdlib.h>

#include "base/clock.h"
#include "base/cores.h"
#include "base/log.h"
#include "base/memory.h"
#include "model/model.h"
#include "run/branch.h"
#include "run/writer.h"

static struct cost now(void)
{
    return (struct cost){clock_cpu_seconds(), clock_seconds()};
}

static struct cost since(struct cost then)
{
    const struct cost n = now();
    return (struct cost){n.cpu - then.cpu, n.wall - then.wall};
}

static void add(struct cost *sum, struct cost one, double times)
{
    sum->cpu += times * one.cpu;
    sum->wall += times * one.wall;
}

double cost_seconds(const struct gpu *gpu, struct cost c)
{
    return gpu_info(gpu)->is_cpu ? c.cpu / cores() : c.wall;
}

/* ---- one frame */

static unsigned files_of(const struct job *job, int frame)
{
    unsigned set = 0;
    for (int kind = 0; 1 << kind < REHEARSAL_SETS; kind++)
        set |= (unsigned)job_writes(job, (enum job_files)kind, frame) << kind;
    return set;
}

/* Sets the output keys so that `frame` has exactly this set of files. */
static void select_files(struct job *job, const struct job *as_it_is, int frame, unsigned set)
{
    const int64_t never = INT64_MAX;
    job->frames = (struct frame_range){frame - 1, frame + 1, 1};
    job->output.vdb = as_it_is->output.vdb;
    job->output.aov = as_it_is->output.aov;
    job->output.vdb.every = set & 1 << JOB_VOLUMES ? 1 : never;
    job->output.vdb.points_every = set & 1 << JOB_POINTS ? 1 : never;
    job->output.aov.every = set & 1 << JOB_PICTURES ? 1 : never;
}

/* Makes the current frame with this set of files and writes it into memory. `job`, which the model refers to, is changed and
 * restored. */
static status time_output(struct gpu *gpu, struct model *model, struct job *job, unsigned set,
                          struct cost *made, struct cost *written)
{
    status st = OK;
    struct frame frame = {0};
    const struct job as_it_is = *job;
    struct cost start = now();
    select_files(job, &as_it_is, model_frame(model), set);
    TRY(model_output(model, &frame));
    TRY(gpu_wait(gpu));
    *made = since(start);
    start = now();
    TRY(frame_write(job, &(struct job_states){0}, "", &frame));
    *written = since(start);
done:
    frame_free(&frame);
    *job = as_it_is;
    return st;
}

/* The same for every set of files that frames of the job have; `last` tells the last rehearsed frame from the first. */
static status time_outputs(struct gpu *gpu, struct model *model, struct job *job, bool last,
                           struct rehearsal *out)
{
    status st = OK;
    unsigned sets = 0;
    for (int f = job->frames.first; f <= job->frames.last; f++)
        sets |= 1U << files_of(job, f);
    for (unsigned set = 0; set < REHEARSAL_SETS; set++)
        if (sets & 1U << set)
            TRY(time_output(gpu, model, job, set, &out->made[last][set], &out->written[last][set]));
done:
    return st;
}

static status time_checkpoint(struct model *model, struct cost *took)
{
    status st = OK;
    struct checkpoint c;
    void *bytes = NULL;
    size_t size;
    const struct cost start = now();
    TRY(model_save(model, &c));
    st = checkpoint_encode(&c, &bytes, &size);
    checkpoint_free(&c);
    TRY(st);
    *took = since(start);
done:
    free(bytes);
    return st;
}

/* ---- frames */

/* The mean of steps first .. first + n - 1. */
static struct cost mean(const struct rehearsal *r, size_t first, size_t n)
{
    struct cost sum = {0};
    for (size_t i = first; i < first + n; i++)
        add(&sum, r->each[i], 1.0 / (double)n);
    return sum;
}

/* Steps until `patience` is spent, but at least twice if the job has two steps. The first step is left out of the expected step,
 * because it compiles kernels. */
static status time_steps(struct gpu *gpu, struct model *model, const struct job *job, double patience,
                         struct rehearsal *out)
{
    status st = OK;
    double spent = 0;
    while (model_frame(model) < job->frames.last && (out->n_each < 2 || spent < patience)) {
        const struct cost start = now();
        TRY(model_step(model));
        TRY(gpu_wait(gpu));
        TRY(memory_grow(&out->each, &out->capacity, out->n_each + 1, sizeof *out->each, "the rehearsal"));
        out->each[out->n_each] = since(start);
        spent += cost_seconds(gpu, out->each[out->n_each++]);
    }
    if (out->n_each)
        out->step = out->n_each > 1 ? mean(out, 1, out->n_each - 1) : out->each[0];
    out->frames.last = model_frame(model);
done:
    return st;
}

status rehearse(struct gpu *gpu, const struct job *job, double patience, struct rehearsal *out)
{
    status st = OK;
    struct model *model = NULL;
    struct branch_state from = {0};
    struct job shown = *job;
    struct cost made, written;
    const struct cost start = now();
    const bool hushed = log_silence(true);
    const unsigned set = files_of(job, job->frames.first);
    *out = (struct rehearsal){.frames = {job->frames.first, job->frames.first, 1}};
    if (*job->from)
        TRY(branch_load(job, &from));
    TRY(model_create(gpu, &shown, *job->from ? &from.at : NULL, &model));
    TRY(time_output(gpu, model, &shown, set, &made, &written));
    out->start = since(start);
    TRY(time_outputs(gpu, model, &shown, false, out));
    TRY(time_steps(gpu, model, job, patience, out));
    TRY(time_outputs(gpu, model, &shown, true, out));
    TRY(time_checkpoint(model, &out->checkpoint));
    /* rehearsal_total() counts the first frame's files with those of the other frames. */
    add(&out->start, out->made[0][set], -1);
    add(&out->start, out->written[0][set], -1);
done:
    log_silence(hushed);
    checkpoint_free(&from.at);
    model_destroy(&model);
    return st;
}

void rehearsal_free(struct rehearsal *r)
{
    free(r->each);
    *r = (struct rehearsal){0};
}

/* ---- the whole job */

void rehearsal_correct_steps(struct rehearsal *r, const struct rehearsal *longer)
{
    if (r->n_each < 2 || longer->n_each <= r->n_each)
        return;
    const struct cost here = mean(longer, 1, r->n_each - 1),
                      after = mean(longer, r->n_each, longer->n_each - r->n_each);
    r->step.cpu *= here.cpu > 0 ? after.cpu / here.cpu : 1;
    r->step.wall *= here.wall > 0 ? after.wall / here.wall : 1;
}

/* Elapsed time of a frame: the previous frame is written meanwhile, and both compete for the cores. */
static double elapsed(double made, double written, double cpu)
{
    return fmax(fmax(made, written), cpu / cores());
}

struct cost rehearsal_total(const struct rehearsal *r, const struct job *job)
{
    struct cost sum = r->start;
    const int rehearsed = r->frames.last - r->frames.first, all = job->frames.last - job->frames.first;
    for (size_t i = 0; i < r->n_each; i++)
        add(&sum, r->each[i], 1);
    add(&sum, r->step, all - rehearsed);
    double n = 1 + ceil((double)all / (double)job->checkpoint.every);
    add(&sum, r->checkpoint, n);
    for (int f = job->frames.first; f <= job->frames.last; f++) {
        const unsigned set = files_of(job, f);
        const double late = f >= r->frames.last ? 1 : (double)(f - r->frames.first) / rehearsed;
        struct cost made = {0}, written = {0};
        add(&made, r->made[0][set], 1 - late);
        add(&made, r->made[1][set], late);
        add(&written, r->written[0][set], 1 - late);
        add(&written, r->written[1][set], late);
        sum.cpu += made.cpu + written.cpu;
        sum.wall += elapsed(r->step.wall + made.wall, written.wall, r->step.cpu + made.cpu + written.cpu) -
                    r->step.wall;
    }
    return sum;
}

/* Extrapolates a cost of `a` at na and `b` at nb particles to n, by a power law whose exponent is held between 2/3, the growth of a
 * surface, and 4/3, a little more than that of a volume. */
static double extrapolate(double a, double b, double na, double nb, double n)
{
    const double power = a > 0 && b > 0 && nb != na ? log(b / a) / log(nb / na) : 1;
    return b * pow(n / nb, fmin(fmax(power, 2.0 / 3), 4.0 / 3));
}

void rehearsal_scale(const struct rehearsal *a, const struct rehearsal *b, double n, struct rehearsal *out)
{
    const double linear = n / b->n_particles;
    *out = (struct rehearsal){.frames = {b->frames.first, b->frames.first, 1}, .n_particles = n};
#define GROW(part)                                                                                           \
    out->part.cpu = extrapolate(a->part.cpu, b->part.cpu, a->n_particles, b->n_particles, n);                \
    out->part.wall = extrapolate(a->part.wall, b->part.wall, a->n_particles, b->n_particles, n)
    GROW(step);
    GROW(checkpoint);
    for (int set = 0; set < REHEARSAL_SETS; set++) {
        GROW(made[1][set]);
        GROW(written[1][set]);
    }
#undef GROW
    /* Compiling kernels is most of the first rehearsal's start, and the second finds them compiled. */
    add(&out->start, b->start, linear);
    if (a != b)
        add(&out->start, a->start, 1);
}
