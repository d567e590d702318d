/* The ground around and below the rock, to the horizon.
 *
 * Within the box   It is level, and rises a little against the foot of the rock, which it joins without a gap.
 * Beyond a wall    It is as high as the rock at the wall, so that plateaus and cliffs run on out of the picture.
 * Beyond an open side   Sand leans against what ends there.
 * Farther out      Waves of 0.5 m to 500 m, by the metre, which begin away from the box and stay below every camera's line of sight
 *                  to it.
 *
 * It depends on the frame only where rock stands or ends: what lies more than a few spacings from a change stays.
 */
#ifndef HOODOO_GROUND_H
#define HOODOO_GROUND_H

#include "base/text.h"
#include "render/view.h"
#include "render/waves.h"
#include "vdb/vdb.h"

struct ground {
    struct view view;
    unsigned walls; /* WALL_* */
    int nx, ny;     /* nodes over the box */
    double dx, dy;  /* m */
    float *top;     /* [ny][nx] m: the rock's highest point, 0 where there is none */
    float *apron;   /* [ny][nx] m */
    double lean;    /* m: how high sand lies against what ends at an open side */
    struct waves waves;
};

/* `mesh` is the frame's rock. E_MEMORY. */
MUST_USE status ground_make(const struct job *job, const struct view *view, const struct vdb_mesh *mesh,
                            struct ground *out);
void ground_free(struct ground *g);

/* Its height; `finest` is the shortest wave wanted (m). */
double ground_at(const struct ground *g, double x, double y, double finest);

/* The rock's highest point over a place in the box; 0 where there is none, and outside. */
double ground_top(const struct ground *g, double x, double y);

/* Adds it as the meshes Ground_Near and Ground_Far; `turns` are the directions in which it is sampled. */
MUST_USE status ground_write(const struct ground *g, int turns, struct text *out);

#endif
