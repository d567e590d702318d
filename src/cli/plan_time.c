#include "cli/plan_time.h"

#include <math.h>
#include <stdio.h>

#include "base/log.h"
#include "run/memory.h"

/* Particles of the first rehearsal, which is quick on any device and shows how large the next one may be. */
static const double FEW = 30000;

/* Particles above which the speed of the device must be known before a rehearsal. */
static const double MANY = 300000;

/* Loads the first wedge at another spacing; *f stays empty if that is not possible. */
static status load_at(const struct plan_asked *asked, const struct farm *own, double spacing, struct farm *f)
{
    status st = OK;
    struct arguments sets = {0};
    const struct common *c = asked->common;
    const struct job *job = own->wedge[0].job;
    char set[64];
    snprintf(set, sizeof set, "domain.spacing_m=%.4g", spacing);
    for (size_t i = 0; i < c->sets.n; i++)
        TRY(arguments_add(&sets, c->sets.item[i]));
    TRY(arguments_add(&sets, set));
    const bool hushed = log_silence(true);
    st = farm_load(asked->path, sets.item, sets.n, NULL, (int)job->wedge.index, c->out, f);
    log_silence(hushed);
    /* The wedges may vary the spacing itself, and a coarse scene may be empty. */
    if (st != OK || f->wedge[0].job->domain.spacing_m < 1.01 * job->domain.spacing_m) {
        farm_free(f);
        *f = (struct farm){0};
        st = st == E_MEMORY ? st : OK;
    }
done:
    arguments_free(&sets);
    return st;
}

static bool fits(const struct gpu *gpu, const struct farm *f)
{
    return run_memory_fits(run_memory_available(gpu),
                           run_memory_needed(gpu, &f->wedge[0].estimate, PACE_STREAM));
}

static status rehearse_wedge(struct gpu *gpu, const struct farm *f, double patience, struct rehearsal *out)
{
    status st = rehearse(gpu, f->wedge[0].job, patience, out);
    out->n_particles = (double)f->wedge[0].estimate.n_particles;
    return st;
}

/* The same at a spacing with about n particles. *out is unchanged if that is not possible. */
static status rehearse_coarse(const struct plan_asked *asked, struct gpu *gpu, const struct farm *own,
                              double n, double patience, struct rehearsal *out)
{
    status st = OK;
    struct farm f = {0};
    const double all = (double)own->wedge[0].estimate.n_particles;
    TRY(load_at(asked, own, own->wedge[0].job->domain.spacing_m * cbrt(all / n), &f));
    if (f.n_wedges == 0 || !fits(gpu, &f))
        goto done;
    st = rehearse_wedge(gpu, &f, patience, out);
    if (st != OK && st != E_DEVICE && st != E_MEMORY) {
        rehearsal_free(out); /* a failure of the coarse job need not be one of the job itself */
        st = OK;
    }
done:
    farm_free(&f);
    return st;
}

/* Seconds that a rehearsal of two steps takes. */
static double shortest(const struct gpu *gpu, const struct rehearsal *r)
{
    double sum =
        cost_seconds(gpu, r->start) + 2 * cost_seconds(gpu, r->step) + cost_seconds(gpu, r->checkpoint);
    for (int set = 0; set < REHEARSAL_SETS; set++)
        sum += 2 * (cost_seconds(gpu, r->made[1][set]) + cost_seconds(gpu, r->written[1][set]));
    return sum;
}

static status rehearse_job(const struct plan_asked *asked, struct gpu *gpu, const struct farm *f,
                           struct plan_time *out)
{
    status st = OK;
    const struct job *job = f->wedge[0].job;
    const double n = (double)f->wedge[0].estimate.n_particles, patience = asked->patience;
    struct rehearsal few = {0}, more = {0}, whole = {0};
    double may = n <= MANY ? n : 0; /* particles that patience allows */
    char range[48];
    if (n > FEW && !*job->from) {
        TRY(rehearse_coarse(asked, gpu, f, FEW, patience / 2, &few));
        if (few.n_particles > 0)
            may = few.n_particles * patience / 2 / shortest(gpu, &few);
    }
    if (may >= n && fits(gpu, f)) {
        TRY(rehearse_wedge(gpu, f, few.n_particles > 0 ? patience / 2 : patience, &whole));
        rehearsal_correct_steps(&whole, &few);
        whole.start.cpu += few.start.cpu;
        whole.start.wall += few.start.wall;
        snprintf(out->from, sizeof out->from, "frames %s, rehearsed", range_text(whole.frames, range));
    } else if (few.n_particles > 0) {
        if (may > 2 * few.n_particles)
            TRY(rehearse_coarse(asked, gpu, f, fmin(may, n / 1.5), 0, &more));
        const struct rehearsal *last = more.n_particles > 0 ? &more : &few;
        rehearsal_correct_steps(&more, &few);
        rehearsal_scale(&few, last, n, &whole);
        snprintf(out->from, sizeof out->from,
                 "frames %s, rehearsed with %.2g particles and extrapolated, within a factor of two",
                 range_text(last->frames, range), last->n_particles);
    } else {
        goto done;
    }
    out->job = rehearsal_total(&whole, job);
done:
    rehearsal_free(&few);
    rehearsal_free(&more);
    rehearsal_free(&whole);
    return st;
}

status plan_frame_times(const struct plan_asked *asked, struct gpu *gpu, struct farm *f,
                        struct plan_time *out)
{
    status st = OK;
    const struct farm_wedge *first = &f->wedge[0];
    const double n = (double)range_count(first->job->frames);
    TRY(farm_measure(f));
    if (first->frame_seconds > 0) {
        out->job.wall = first->frame_seconds * n;
        snprintf(out->from, sizeof out->from, "existing frames");
    } else if (gpu && asked->patience > 0) {
        TRY(rehearse_job(asked, gpu, f, out));
    }
    for (size_t i = 0; i < f->n_wedges; i++) {
        struct farm_wedge *w = &f->wedge[i];
        if (w->frame_seconds == 0)
            w->frame_seconds =
                out->job.wall / n * (double)w->estimate.n_particles / (double)first->estimate.n_particles;
    }
done:
    return st;
}
