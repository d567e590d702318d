/* Rocks of boxes. */
#ifndef HOODOO_TESTS_BOXES_H
#define HOODOO_TESTS_BOXES_H

#include "check.h"

#include "particles/rock.h"

struct box {
    double min[3], max[3];
};

/* One particle in the middle of every voxel inside one of the boxes. */
static inline struct rock box_rock(const struct box *box, size_t n_boxes, const int voxels[3], double h)
{
    struct rock rock;
    size_t n = 0;
    for (int pass = 0; pass < 2; pass++) {
        if (pass == 1)
            assert_ok(rock_alloc(&rock, n, STATE));
        n = 0;
        for (int k = 0; k < voxels[2]; k++)
            for (int j = 0; j < voxels[1]; j++)
                for (int i = 0; i < voxels[0]; i++) {
                    double x[3] = {(i + 0.5) * h, (j + 0.5) * h, (k + 0.5) * h};
                    int inside = 0;
                    for (size_t b = 0; b < n_boxes; b++)
                        inside |= x[0] > box[b].min[0] && x[0] < box[b].max[0] && x[1] > box[b].min[1] &&
                                  x[1] < box[b].max[1] && x[2] > box[b].min[2] && x[2] < box[b].max[2];
                    if (!inside)
                        continue;
                    if (pass == 1) {
                        for (int a = 0; a < 3; a++)
                            rock.P[4 * n + (size_t)a] = (float)x[a];
                        rock.id[n] = (uint32_t)n;
                        rock.viability[n] = 1;
                        rock.rate_factor[n] = rock.interlock_factor[n] = 1;
                    }
                    n++;
                }
    }
    return rock;
}

#endif
