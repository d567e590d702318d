#include "model/resample.h"

#include <math.h>
#include <string.h>

#include "base/log.h"
#include "model/resampling.h"
#include "model/type.h"
#include "scene/scene.h"

status resampling_keep(struct resampling *r, const char *prefix)
{
    status st = OK;
    for (size_t i = 0; i < r->from->n_sections; i++) {
        const struct checkpoint_section *s = &r->from->section[i];
        void *data;
        if (strncmp(s->name, prefix, strlen(prefix)) != 0)
            continue;
        TRY(section_add(r->out, s->name, s->item, s->n, &data));
        memcpy(data, s->data, s->n * s->item);
    }
done:
    return st;
}

/* Adds the ledger of the new state. What does not stand has fallen or left, in that order as far as the checkpoint's counts go. */
static status add_counts(struct resampling *r)
{
    status st = OK;
    struct ledger *l = &r->counts;
    const uint64_t gone = l->start - l->rock - l->deposit,
                   fallen = (uint64_t)((double)r->ledger.fallen * r->times);
    const struct checkpoint_section *volume = checkpoint_find(r->from, "start volume", 8),
                                    *change = checkpoint_find(r->from, "change", 8);
    void *data;
    l->fallen = fallen < gone ? fallen : gone;
    l->left = gone - l->fallen;
    TRY(section_add(r->out, "ledger", 8, sizeof *l / 8, &data));
    memcpy(data, l, sizeof *l);
    if (volume)
        TRY(resampling_keep(r, volume->name));
    if (change) {
        TRY(section_add(r->out, change->name, 8, change->n, &data));
        for (size_t i = 0; i < change->n; i++)
            ((int64_t *)data)[i] = (int64_t)llround((double)((const int64_t *)change->data)[i] * r->times);
    }
done:
    return st;
}

static status fail_spacing(const struct resampling *r)
{
    return fail(
        E_CHECKPOINT,
        "the checkpoint of frame %d has %d x %d x %d voxels of %g m, but this job's domain has %d x %d x %d of %g m; give the job the same domain, and the same spacing or a half, a quarter or twice of it (any whole ratio up to %d)",
        r->from->frame, r->ratio.was.n[0], r->ratio.was.n[1], r->ratio.was.n[2], r->ratio.was.h,
        r->ratio.is.n[0], r->ratio.is.n[1], r->ratio.is.n[2], r->ratio.is.h, RESAMPLE_MOST);
}

status model_resample(const struct job *job, struct checkpoint *c, double *was_m)
{
    status st = OK;
    struct checkpoint out = {
        .frame = c->frame, .years = c->years, .job_hash = c->job_hash, .maker = c->maker};
    struct resampling r = {.job = job, .before = *job, .from = c, .out = &out};
    const struct model_type *type = model_type_of(job);
    TRY(section_get_spacing(c, r.ratio.was.n, &r.ratio.was.h));
    *was_m = r.ratio.was.h;
    TRY(scene_voxels(job, r.ratio.is.n));
    r.ratio.is.h = job->domain.spacing_m;
    if (r.ratio.was.h == r.ratio.is.h)
        return OK;
    r.before.domain.spacing_m = r.ratio.was.h;
    r.times = pow(r.ratio.was.h / r.ratio.is.h, 3);
    if (!resample_fits(&r.ratio))
        return fail_spacing(&r);
    TRY(section_check_domain(c, &r.before));
    TRY(section_get_ledger(c, &r.ledger));
    TRY(section_add_domain(&out, job));
    TRY(type->resample(&r));
    TRY(add_counts(&r));
    log_info("frame %d: the state of %g m was resampled at %g m: %llu %s", c->frame, r.ratio.was.h,
             r.ratio.is.h, (unsigned long long)(r.counts.rock + r.counts.deposit), job_model(job)->samples);
    checkpoint_free(c);
    *c = out;
    out = (struct checkpoint){0};
done:
    checkpoint_free(&out);
    return st;
}
