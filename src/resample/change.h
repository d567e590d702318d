/* What finer.c and coarser.c share. Private to src/resample. */
#ifndef HOODOO_RESAMPLE_CHANGE_H
#define HOODOO_RESAMPLE_CHANGE_H

#include "particles/voxel_set.h"
#include "resample/resample.h"

/* Old voxels in which rock stands; arrays by their index in the set. */
struct standing {
    struct voxel_set at;
    size_t *particle;        /* the one of the lowest id */
    float *fill;             /* share of rock */
    float *first;            /* what it was at the start; 0: the particle is not of the scene */
    float *rate, *interlock; /* factors that edits have painted */
};

struct change {
    const struct resample *r;
    const struct rock *was;
    const uint32_t *deep;                      /* NULL: none */
    const struct scene_source *before, *scene; /* at the old spacing and at the new one */
    struct standing standing;
    struct voxel_set deposits; /* old voxels with deposits */
    struct resample_to *to;
};

/* The voxel of a position, computed in floats like in the kernels. */
void voxel_of(const struct spacing *s, const float P[4], int v[3]);

/* How much of an old voxel is ground. Below the domain is rock; beyond its sides is what is inside of them. */
double change_ground(const struct change *c, const int at[3]);

/* Allocates room for n particles; none is there yet. */
MUST_USE status change_reserve(struct change *c, size_t n);

/* Appends a particle at a voxel: number `own` of the particles of `scene`, with painted factors; or, if own is SIZE_MAX, one with a new id
 * that takes its values from particle `from` of the old rock. Plants, age and phase are those of `from`; SIZE_MAX: none, and rock. */
void change_append(struct change *c, const int v[3], const struct rock *scene, size_t own, float rate,
                   float interlock, size_t from, float viability);

/* At a smaller spacing: appends the deposits, at most heaps_most() particles. */
size_t heaps_most(const struct change *c);
MUST_USE status heaps_divide(struct change *c);

/* Make the new rock. */
MUST_USE status change_finer(struct change *c);
MUST_USE status change_coarser(struct change *c);

#endif
