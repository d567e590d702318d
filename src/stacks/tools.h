/* What the tools share: the stacks under the tool, and what it has reached so far. Private to stacks/. */
#ifndef HOODOO_TOOLS_H
#define HOODOO_TOOLS_H

#include "stacks/operations.h"

struct work {
    struct stacks *stacks;
    const struct tools *tools;
    const struct job_operation *op;
    const char *name; /* for errors: "arches.operations.3" */
    uint32_t solids;
    struct surface surface; /* of the solids */
    int lo[2], hi[2];       /* edited so far */
};

/* stacks_edit(), remembered. */
MUST_USE status work_edit(struct work *w, const int lo[2], const int hi[2], column_edit edit, void *user);

/* Water up to the operation's level in what its points' spaces connect to below it; out of the same spaces
 * above it. */
MUST_USE status fill_water(struct work *w);

#endif
