/* The layer at any point of a rock's surface: that of the nearest particle. */
#ifndef HOODOO_LAYERS_H
#define HOODOO_LAYERS_H

#include <stdbool.h>

#include "particles/rock.h"

struct layers {
    const struct rock *rock;
    double low[3], cell;
    int n[3];
    size_t *first;    /* [cells + 1]: index in `sorted` of each cell's first particle */
    uint32_t *sorted; /* particle numbers, sorted by cell */
};

/* `rock`, with P and layer, must outlive *out. `spacing`: of its particles, m. E_MEMORY. */
MUST_USE status layers_create(const struct rock *rock, double spacing, struct layers *out);
void layers_destroy(struct layers *layers);

/* The layer of the particle nearest to `at`, the first of equals. False: none is within twice the spacing. Thread-safe. */
bool layers_at(const struct layers *layers, const float at[3], uint32_t *layer);

#endif
