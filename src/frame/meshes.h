/* A frame's meshes, made from its files: the surface of the rock, and the rocks that lie on it in piles.
 *
 * The surface is the zero level of the surface field (field/field.h), which pictures and volumes show as well. tests/bench/surface
 * compares this surface with alternatives. On a ball and a tilted wall cut from the rock, its error is 0.01 spacings (normals 2
 * degrees). Averaged spheres as by Zhu and Bridson have 0.1 to 0.16 spacings (12 degrees): every particle shows, twice as much of a
 * ball faces the axes as should, and an arch gains 12 % of its volume. Poisson reconstruction from the particles' normals has 0.05 to
 * 0.1 spacings; it rounds ledges and closes the faces cut by the domain with bulges. */
#ifndef HOODOO_MESHES_H
#define HOODOO_MESHES_H

#include <stdbool.h>

#include "job/job.h"
#include "output/product.h"
#include "usd/usd.h"

struct meshes {
    struct recipe recipe; /* its frame and source are filled in for each frame */
    const struct job *job;
    double adaptivity; /* 0..1 voxels: how far the surface may move when it is simplified */
    int smooth;        /* passes of smoothing */
    bool rocks;        /* also writes mesh/NAME.rocks.FRAME, if the job has piles */
};

/* Writes mesh/NAME.FRAME.ply and .obj and, for the surface, .usdc. The layer of a vertex is that of the nearest particle or, if the
 * frame has no points, follows from its position. */
MUST_USE status meshes_write(const struct meshes *m, int frame);

/* The prim and attributes of the meshes' USD files. */
void meshes_prim(const struct job *job, struct usd_prim *out);

/* Whether the meshes exist, are intact, and were made by this command from the frame as it is now. E_MEMORY. */
MUST_USE status meshes_done(const struct meshes *m, int frame, bool *done);

#endif
