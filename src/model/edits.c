#include "model/edits.h"

#include "base/log.h"
#include "scene/scene.h"

enum edits_kind edits_of(const struct job *job, int frame)
{
    enum edits_kind kind = EDITS_NONE;
    for (size_t i = 0; i < job->n_edits; i++) {
        const struct job_edit *e = &job->edits[i];
        if (e->frame != frame)
            continue;
        if (e->carve || e->n_add || e->n_paint)
            return EDITS_ROCK;
        kind = EDITS_SET;
    }
    return kind;
}

bool edits_ever(const struct job *job, bool (*wanted)(const struct job *))
{
    bool any = wanted(job);
    for (size_t i = 0; i < job->n_edits && !any; i++)
        any = job->edits[i].set.job && wanted(job->edits[i].set.job);
    return any;
}

bool edits_plant(const struct job *job)
{
    for (size_t i = 0; i < job->n_edits; i++)
        for (size_t k = 0; k < job->edits[i].n_paint; k++)
            if (job->edits[i].paint[k].vegetation > 0)
                return true;
    return false;
}

status edits_apply(const struct job *job, int frame, struct rock *rock, struct ledger *ledger,
                   double *start_volume)
{
    status st = OK;
    for (size_t i = 0; i < job->n_edits; i++) {
        const struct job_edit *e = &job->edits[i];
        struct scene_edited done;
        if (e->frame != frame)
            continue;
        /* `start` counts every particle that ever existed, so it is the next free id. */
        TRY(scene_edit(job_at(job, frame), e, ledger->start, rock, &done));
        ledger->start += done.added;
        ledger->left += done.carved;
        *start_volume += done.added_m3;
        log_info("frame %d: edit %zu added %zu %s and carved %zu out", frame, i, done.added,
                 job_model(job)->samples, done.carved);
        if (e->n_add && done.added_m3 <= 0)
            log_warn(
                "frame %d: edit %zu adds no rock: its shapes are outside the domain, or there is rock already",
                frame, i);
    }
done:
    return st;
}
