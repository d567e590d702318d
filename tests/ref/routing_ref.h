/* Where things flow to over a shape, in plain C, without passes over pits: kinds, altitudes and receivers of
 * cells as deposit_routing has them. */
#ifndef HOODOO_TESTS_ROUTING_REF_H
#define HOODOO_TESTS_ROUTING_REF_H

#include <stdint.h>

#include "particles/rock.h"

struct routing_ref {
    int cells[3], shift[3];
    uint32_t *tag, *z, *receiver; /* routing_ref_free() */
};

/* `seed` says how the grid is shifted (unless it is to stay where it is) and which of several ways is taken. Pits and outlets keep to
 * themselves. */
struct routing_ref routing_ref(const struct rock *rock, const int voxels[3], double h, uint32_t seed,
                               int unshifted);
void routing_ref_free(struct routing_ref *r);

#endif
