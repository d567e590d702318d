/* The terrain of arches: how it is made from the job, and how frames sample it. */
#ifndef HOODOO_TERRAIN_H
#define HOODOO_TERRAIN_H

#include "field/field.h"
#include "job/job.h"
#include "particles/frame.h"
#include "stacks/operations.h"
#include "stacks/surface.h"

/* The job's materials, indexed by the material numbers of layers. E_USAGE: too many. */
MUST_USE status terrain_materials(const struct job *job, struct material table[MATERIALS_MAX], int *n);

/* The side of a stack, m. */
double terrain_cell(const struct job *job);

/* Half the width of the filter through which frames see the surface, m: not narrower than voxels can resolve. */
double terrain_sigma(const struct job *job, double cell, double voxel);

/* What the job's operations need; valid as long as job and table are. */
struct tools terrain_tools(const struct job *job, const struct stacks *s, const struct material *table,
                           int n_materials);

/* The set of materials that the surface encloses: all but air and water, and not rock layers if they are shown as instanced rocks. */
uint32_t terrain_ground(const struct job *job, int n_materials);

/* Creates the job's stacks without any layers. */
MUST_USE status terrain_create(const struct job *job, struct stacks *out);

/* Fills the stacks with the scene as bedrock and the job's covers on it. `log`: says what the scene's files hold. */
MUST_USE status terrain_begin(const struct job *job, const struct material *table, int n_materials, bool log,
                              struct stacks *s);

/* The total volumes of solid and of loose material, in quanta. */
void terrain_ledger(const struct stacks *s, const struct material *table, int n_materials, uint64_t *solid,
                    uint64_t *loose);

/* Terrain that changes. count() is called after each change, with the quanta of loose material that have left across the sides; NULL: nobody
 * counts, and nothing is logged. */
struct terrain_work {
    const struct job *job;
    struct stacks *stacks;
    const struct material *table;
    int n_materials;
    void (*count)(void *user, uint64_t left);
    void *user;
};

/* The stacks lo..hi; none if hi < lo. */
struct terrain_area {
    int lo[2], hi[2];
};

/* Applies the frame's tools in the job's order, and loosens rock that nothing holds, if the job wants that. *area: where material may
 * slide; everywhere if `all`. E_USAGE, E_MEMORY. */
MUST_USE status terrain_shape(const struct terrain_work *w, int frame, bool all, struct terrain_area *area);

/* Lets loose material slide until it rests. E_MEMORY. */
MUST_USE status terrain_slide(const struct terrain_work *w, int frame, const struct terrain_area *area);

/* About the largest surface that the terrain has in its frames, m2, as a staircase: faces along the axes. */
struct terrain_size {
    double surface_m2; /* of the ground: floors, ceilings and walls */
    double side_m2;    /* of the ground where the domain ends, its floor included */
    double layers;     /* per stack */
};

/* Finds it by running the job on coarse stacks, up to its 256th frame with changes: surfaces smaller than these stacks are missed. E_USAGE: an operation is wrong. E_MEMORY. */
MUST_USE status terrain_size(const struct job *job, struct terrain_size *out);

enum { TERRAIN_RATIOS = MATERIALS_OWN - MATERIAL_BEDROCK };

/* A frame's samples of the stacks, on the lattice of the surface field (field.h): n samples along each axis from `origin`, `voxel`
 * apart. Kept are the bricks (particles/grids.h) in or near which the surface is, and those inside that are not all bedrock.
 *
 * Each sample in the ground shows one material, except at the surface, where it may show several: those samples are particles, and only
 * they have shares of materials. */
struct terrain_view {
    const struct job *job;
    const struct stacks *stacks;
    int n_materials;
    int n[3];
    double origin[3], voxel;
    struct field_cut cut; /* samples at it are particles, too */
    struct grid_bricks bricks;
    float *share;     /* [bricks * 512]: share of ground, 1/2 on the surface; 0 beyond the lattice */
    struct rock rock; /* one particle for every voxel at the surface; fields that are 0 everywhere are NULL */
    /* Of what shows at each sample: */
    uint8_t *found;                 /* [bricks * 512]: the material with the largest share, and flags */
    size_t *first;                  /* [bricks + 1]: each brick's first particle, in the order of samples */
    float (*ratio)[TERRAIN_RATIOS]; /* [particles]: shares of the materials from MATERIAL_BEDROCK on */
};

/* Fills bricks, share, rock, found, first and ratio. Free with terrain_view_free(); the caller may free `share` and `rock` before. */
MUST_USE status terrain_sample(struct terrain_view *v);

/* The share of a material at each sample: [bricks * 512]. Needs neither `share` nor `rock`. */
void terrain_ratio(const struct terrain_view *v, int material, float *out);
void terrain_view_free(struct terrain_view *v);

/* The surface to sample (stacks/surface.h): its materials and the width of its filter. */
struct surface terrain_surface(const struct terrain_view *v);

/* Finds the view's bricks. */
MUST_USE status terrain_bricks(struct terrain_view *v, const struct surface *s);

/* A picture from above named "stacks", with one pixel for each stack: the height and the thickness of each material. */
MUST_USE status terrain_map(const struct stacks *s, int n_materials, struct aov_image *out);

#endif
