/* Arches' terrain between its job and its frames: how it begins, and what of it a frame shows. */
#ifndef HOODOO_TERRAIN_H
#define HOODOO_TERRAIN_H

#include "job/job.h"
#include "particles/frame.h"
#include "stacks/stacks.h"

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
 * on each axis from `origin`, `voxel` apart. */
struct terrain_view {
    const struct job *job;
    const struct stacks *stacks;
    int n_materials;
    int n[3];
    double origin[3], voxel;
    float *share; /* [samples]: of ground, 1/2 on the surface */
    float *
        ratio[TERRAIN_RATIOS]; /* [samples]: of each material from MATERIAL_BEDROCK on, in what shows there */
    struct rock rock;          /* one particle for every voxel at the surface */
};

/* Fills share, ratio and rock; the caller frees them with terrain_view_free(). */
MUST_USE status terrain_look(struct terrain_view *v);
void terrain_view_free(struct terrain_view *v);

/* The samples that are looked at, for a domain of these voxels. */
uint64_t terrain_samples(const int voxels[3]);

/* What looking takes in host memory, for a domain of these voxels, but for the rock. */
uint64_t terrain_view_bytes(const int voxels[3]);

/* The heights and thicknesses of the layers as a picture from above, one pixel a stack: named "stacks". */
MUST_USE status terrain_map(const struct stacks *s, int n_materials, struct aov_image *out);

#endif
