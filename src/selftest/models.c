/* Model checks. A small job of each model is run twice, resumed from its middle, and run with every variant of the kernels: the states must be
 * equal bit for bit. Its last frame is also compared with recorded numbers, since a device may be wrong in the same way every time. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "gpu/kernel_source.h"
#include "model/model.h"
#include "selftest/selftest.h"
#include "system/atomic_file.h"

/* Results of a run. */
struct leavings {
    struct checkpoint half, end;
    struct measure measure;
    size_t kernels; /* number of kernels that ran */
};

static void leavings_free(struct leavings *l)
{
    checkpoint_free(&l->half);
    checkpoint_free(&l->end);
}

static status take_measure(struct model *model, struct measure *out)
{
    status st = OK;
    struct frame f = {0};
    TRY(model_output(model, &f));
    double height = 0;
    for (size_t i = 0; i < f.rock.n; i++)
        height += (double)f.rock.P[4 * i + 2];
    *out = (struct measure){.ledger = f.ledger,
                            .volume_m3 = f.volume_m3,
                            .lost_m3 = f.start_volume_m3 - f.volume_m3,
                            .height_m = f.rock.n ? height / (double)f.rock.n : 0,
                            .stress_p95_Pa = f.rock.stress ? percentile_95(f.rock.stress, f.rock.n) : 0};
done:
    frame_free(&f);
    return st;
}

/* Runs to the job's last frame. Keeps the state in the middle, the last one and its measure. `from` NULL: from the start. */
static status run(struct selftest *t, const struct job *job, int variant, const struct checkpoint *from,
                  struct leavings *out)
{
    status st = OK;
    struct gpu *gpu = NULL;
    struct model *model = NULL;
    const int half = job->frames.first + (job->frames.last - job->frames.first) / 2;
    *out = (struct leavings){0};
    TRY(gpu_create(&(struct gpu_options){.device = t->device, .variant = variant}, &gpu));
    TRY(model_create(gpu, job, from, &model));
    while (model_frame(model) < job->frames.last) {
        TRY(selftest_stop(t));
        TRY(model_step(model));
        if (model_frame(model) == half)
            TRY(model_save(model, &out->half));
    }
    TRY(model_save(model, &out->end));
    TRY(take_measure(model, &out->measure));
    for (int k = 0; k < KERNELS; k++)
        out->kernels += gpu_kernel_time(gpu, (enum gpu_kernel)k)->dispatches > 0;
done:
    model_destroy(&model);
    gpu_destroy(&gpu);
    return st;
}

/* A job and the results of its first run. */
struct trial_run {
    const struct trial *trial;
    struct job *job;
    struct leavings first;
};

static status first_run(struct selftest *t, const void *what, struct row *row)
{
    status st = OK;
    struct trial_run *r = (struct trial_run *)what;
    char why[WHY_BYTES];
    TRY(selftest_load(t, r->trial->line, NULL, 0, &r->job));
    TRY(run(t, r->job, 0, NULL, &r->first));
    const struct measure *m = &r->first.measure;
    if (!same_measure(&r->trial->recorded, m, why))
        row_wrong(row, "after %d frames %s", r->job->frames.last - r->job->frames.first, why);
    row_found(row, "%.6g m3 of rock, %zu kernels", m->volume_m3, r->first.kernels);
    row_value(row, "kernels", (double)r->first.kernels);
    row_value(row, "start", (double)m->ledger.start);
    row_value(row, "rock", (double)m->ledger.rock);
    row_value(row, "volume_m3", m->volume_m3);
    row_value(row, "lost_m3", m->lost_m3);
    row_value(row, "height_m", m->height_m);
    row_value(row, "stress_p95_Pa", m->stress_p95_Pa);
done:
    return st;
}

static void compare(const struct trial_run *r, const struct leavings *again, const char *how, struct row *row)
{
    char why[WHY_BYTES];
    if (!same_state(&r->first.end, &again->end, why))
        row_wrong(row, "%s: %s", how, why);
}

static status second_run(struct selftest *t, const void *what, struct row *row)
{
    status st = OK;
    const struct trial_run *r = what;
    struct leavings again = {0};
    char why[WHY_BYTES];
    TRY(run(t, r->job, 0, NULL, &again));
    if (!same_state(&r->first.half, &again.half, why))
        row_wrong(row, "the second run, half way: %s", why);
    compare(r, &again, "the second run", row);
    row_found(row, "the same state half way and at the end");
done:
    leavings_free(&again);
    return st;
}

static status resumed_run(struct selftest *t, const void *what, struct row *row)
{
    status st = OK;
    const struct trial_run *r = what;
    struct leavings again = {0};
    struct checkpoint half = {0};
    struct path path;
    void *bytes = NULL;
    size_t size = 0;
    TRY(checkpoint_encode(&r->first.half, &bytes, &size));
    TRY(path_join(&path, t->folder.text, "half.ckpt"));
    TRY(atomic_file_write(path.text, bytes, size));
    TRY(checkpoint_read(path.text, &half));
    TRY(run(t, r->job, 0, &half, &again));
    compare(r, &again, "resumed half way", row);
    row_found(row, "the same state at the end");
    row_value(row, "checkpoint_bytes", (double)size);
done:
    free(bytes);
    checkpoint_free(&half);
    leavings_free(&again);
    return st;
}

static status other_variants(struct selftest *t, const void *what, struct row *row)
{
    status st = OK;
    const struct trial_run *r = what;
    static const char *const names[VARIANTS] = {"texel", "storage", "wide"};
    struct leavings again = {0};
    size_t n = 0;
    /* On a CPU, compiling a variant takes longer than all other checks. */
    const size_t most = t->quick ? 1 : VARIANTS;
    for (int variant = 0; variant < VARIANTS && n < most; variant++) {
        if (strcmp(names[variant], t->findings.limits.variant) == 0)
            continue;
        leavings_free(&again);
        TRY(run(t, r->job, variant + 1, NULL, &again));
        compare(r, &again, names[variant], row);
        n++;
    }
    row_found(row, "%zu others, the same state at the end", n);
done:
    leavings_free(&again);
    return st;
}

static status one_trial(struct selftest *t, const struct trial *trial)
{
    status st = OK;
    struct trial_run r = {.trial = trial};
    TRY(selftest_do(t, trial->name, "as recorded", first_run, &r));
    if (r.first.end.n_sections == 0)
        goto done; /* without a first run there is nothing to compare with */
    TRY(selftest_do(t, trial->name, "run again", second_run, &r));
    TRY(selftest_do(t, trial->name, "resumed", resumed_run, &r));
    TRY(selftest_do(t, trial->name, "kernel variants", other_variants, &r));
done:
    leavings_free(&r.first);
    job_destroy(&r.job);
    return st;
}

status selftest_models(struct selftest *t)
{
    status st = OK;
    for (size_t i = 0; i < n_trials; i++)
        TRY(one_trial(t, &trials[i]));
done:
    return st;
}
