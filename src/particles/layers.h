/* The layer at any place of a rock's surface: that of the nearest particle. */
#ifndef HOODOO_LAYERS_H
#define HOODOO_LAYERS_H

#include <stdbool.h>

#include "particles/rock.h"

struct layers {
    const struct rock *rock;
    double low[3], cell;
    int n[3];
    size_t *first;    /* [cells + 1]: where each cell's particles begin in ... */
    uint32_t *sorted; /* ... their numbers */
};

/* `rock`, with P and layer, outlives it. `spacing` of its particles, m. */
MUST_USE status layers_create(const struct rock *rock, double spacing, struct layers *out);
void layers_destroy(struct layers *layers);

/* Of the particle nearest to `at`; among equals the first. False if none is within twice the spacing. */
bool layers_at(const struct layers *layers, const float at[3], uint32_t *layer);

#endif
