/* Water's routing in plain C, cell by cell: Kruskal instead of Boruvka, a flood from the outlets for the
 * levels, a walk down a topological order for the sums. Cells are numbered (k ny + j) nx + i. */
#ifndef HOODOO_TESTS_FLOW_REF_H
#define HOODOO_TESTS_FLOW_REF_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "particles/rock.h"

struct flow_ref {
    int cells[3], size; /* voxels along a cell's side */
    unsigned walls;     /* WALL_* of shared/params.h */
    size_t n;
    uint32_t *tag, *z, *receiver; /* as in water/water.h */
    uint32_t *altitude;           /* of each cell that is not rock: z, or its floor */
    uint32_t *initial;            /* receivers before pits overflow */
    uint32_t *floor;              /* the bottom of the run of empty cells that each cell is in */
    uint64_t *rain;               /* voxel columns that drain through each cell along the receivers */
};

/* Of particles ordered as on the device. `random`: water_random()'s. */
struct flow_ref flow_ref_route(const struct rock *rock, const int voxels[3], double h, int size,
                               const int shift[3], uint32_t random, bool leak, unsigned walls);
void flow_ref_free(struct flow_ref *f);

/* The altitude to which water must rise in each cell to leave the domain; UINT32_MAX where it cannot. A
 * priority flood; knows nothing of receivers but where a roof leaks. The caller's to free. */
uint32_t *flow_ref_levels(const struct flow_ref *f, bool leak);

/* The discharge of `unit` on each voxel's column, split between lower neighbours by these levels, by cell. The caller's to
 * free. */
uint32_t *flow_ref_split(const struct flow_ref *f, const uint32_t *level, const int voxels[3], bool leak,
                         uint32_t unit);

#endif
