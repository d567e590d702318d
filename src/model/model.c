#include "model/model.h"

extern const struct model_type arenite, goblins, arches;

const struct model_type *model_of(const struct job *job)
{
    /* In the order of the key `model`. */
    static const struct model_type *const types[] = {&arenite, &goblins, &arches};
    return types[job->model];
}
