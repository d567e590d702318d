/* State of an operation that is being applied, shared by the tools. Private to src/stacks. */
#ifndef HOODOO_TOOLS_H
#define HOODOO_TOOLS_H

#include "stacks/operations.h"

struct work {
    struct stacks *stacks;
    const struct tools *tools;
    const struct job_operation *op;
    const char *name;       /* for errors: "arches.operations.3" */
    uint32_t solids;        /* set of the materials that do not slide */
    struct surface surface; /* of the solids */
    int lo[2], hi[2];       /* the stacks edited so far */
};

/* stacks_edit(), which also extends lo..hi. */
MUST_USE status work_edit(struct work *w, const int lo[2], const int hi[2], column_edit edit, void *user);

/* Sets the water level in the spaces that are connected, below the operation's level, to those of its points. Water above the level is
 * removed. */
MUST_USE status fill_water(struct work *w);

#endif
