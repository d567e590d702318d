/* What a model's own resampling gets (struct model_type). Only files of src/model include this header. */
#ifndef HOODOO_RESAMPLING_H
#define HOODOO_RESAMPLING_H

#include "model/sections.h"
#include "resample/resample.h"

struct resampling {
    const struct job *job; /* the job of the new spacing */
    struct job before;     /* the same job at the checkpoint's spacing: a shallow copy, which owns nothing */
    struct resample ratio;
    const struct checkpoint *from;
    struct ledger ledger;   /* of the checkpoint */
    struct checkpoint *out; /* with the section of the domain only */
    struct ledger counts;   /* of the new state, set by the model: start, rock and deposit */
    double times; /* new units of the ledger in one of the checkpoint's: of voxels unless the model sets it */
};

/* Adds copies of the checkpoint's sections whose names begin with `prefix`. */
MUST_USE status resampling_keep(struct resampling *r, const char *prefix);

#endif
