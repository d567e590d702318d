/* The ground around and below the rock, up to the horizon.
 *
 * Within the box        Level; it rises slightly towards the foot of the rock and joins it without a gap.
 * Beyond a wall         As high as the rock at the wall, so that plateaus and cliffs continue beyond the domain.
 * Beyond an open side   Sand is heaped against rock that ends there.
 * Farther out           Waves of 0.5 m to 500 m, fixed in the world. They begin at some distance from the box and stay below the line
 *                       of sight of every camera to it.
 *
 * The ground depends on the frame only near rock: it changes within a few spacings of a change of the rock, and nowhere else.
 */
#ifndef HOODOO_GROUND_H
#define HOODOO_GROUND_H

#include "render/view.h"
#include "render/waves.h"
#include "text/text.h"
#include "vdb/vdb.h"

struct ground {
    struct view view;
    unsigned walls; /* WALL_* */
    int nx, ny;     /* nodes over the box */
    double dx, dy;  /* m */
    float *top;     /* [ny][nx] m: the highest point of the rock, 0 without rock */
    float *apron;   /* [ny][nx] m: rise towards the foot of the rock */
    double lean;    /* m: height of the sand against rock that ends at an open side */
    struct waves waves;
};

/* `mesh` is the surface of the frame's rock. Release with ground_free(). E_MEMORY. */
MUST_USE status ground_make(const struct job *job, const struct view *view, const struct vdb_mesh *mesh,
                            struct ground *out);
void ground_free(struct ground *g);

/* The height of the ground (m) with waves down to the length `finest` (m). */
double ground_at(const struct ground *g, double x, double y, double finest);

/* The highest point of the rock above a place in the box (m); 0 without rock, and outside the box. */
double ground_top(const struct ground *g, double x, double y);

/* Adds the ground as the meshes Ground_Near and Ground_Far; `turns` is the number of directions in which it is sampled. */
MUST_USE status ground_write(const struct ground *g, int turns, struct text *out);

#endif
