/* Arches' terrain between its job and its frames: how it begins, and what of it a frame shows. */
#ifndef HOODOO_TERRAIN_H
#define HOODOO_TERRAIN_H

#include "job/job.h"
#include "particles/frame.h"
#include "stacks/surface.h"

/* The job's materials, by the number layers have them. E_USAGE: too many. */
MUST_USE status terrain_materials(const struct job *job, struct material table[MATERIALS_MAX], int *n);

/* The job's stacks, empty. */
MUST_USE status terrain_create(const struct job *job, struct stacks *out);

/* The scene as bedrock, and the covers on it. */
MUST_USE status terrain_begin(const struct job *job, const struct material *table, int n_materials,
                              struct stacks *s);

/* Everything solid or loose, in quanta. */
void terrain_ledger(const struct stacks *s, const struct material *table, int n_materials, uint64_t *solid,
                    uint64_t *loose);

enum { TERRAIN_RATIOS = MATERIALS_OWN - MATERIAL_BEDROCK };

/* What of a frame is sampled from the stacks, on the lattice that the surface field has (field.h): n samples
 * on each axis from `origin`, `voxel` apart; of these the bricks (particles/grids.h) that the surface is in or near, and those
 * inside that are not all bedrock. */
struct terrain_view {
    const struct job *job;
    const struct stacks *stacks;
    int n_materials;
    int n[3];
    double origin[3], voxel;
    struct grid_bricks bricks;
    float *share; /* [bricks * 512]: of ground, 1/2 on the surface; 0 beyond the lattice */
    float
        *ratio[TERRAIN_RATIOS]; /* likewise: of each material from MATERIAL_BEDROCK on, in what shows there */
    struct rock
        rock; /* one particle for every voxel at the surface; fields that are 0 everywhere are not there */
};

/* Fills bricks, share, ratio and rock; the caller frees them with terrain_view_free(), or takes what it wants. */
MUST_USE status terrain_look(struct terrain_view *v);
void terrain_view_free(struct terrain_view *v);

/* Of a surface: what it is of, and how far its box reaches (stacks/surface.h). */
struct surface terrain_surface(const struct terrain_view *v);

/* Finds the view's bricks. */
MUST_USE status terrain_bricks(struct terrain_view *v, const struct surface *s);

/* The heights and thicknesses of the layers as a picture from above, one pixel a stack: named "stacks". */
MUST_USE status terrain_map(const struct stacks *s, int n_materials, struct aov_image *out);

#endif
