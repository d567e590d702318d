/* A frame's meshes, from its files: the surface, and the rocks that lie on it in piles.
 *
 * The surface is that of the field (field/field.h), which is what pictures and volumes show. tests/bench/surface
 * compares it with what else particles could be surfaced by. In spacings, of a ball and a tilted wall cut from the
 * rock, the field strays 0.01 from the true shape (normals 2 degrees); spheres averaged as by Zhu and Bridson 0.1 to
 * 0.16 (12 degrees: every particle shows, twice as much of a ball faces the axes as should, and an arch gains 12 % of
 * its volume); Poisson reconstruction from the particles' normals 0.05 to 0.1, and it rounds ledges away and closes
 * what the domain cuts off by balloons. */
#ifndef HOODOO_MESHES_H
#define HOODOO_MESHES_H

#include <stdbool.h>

#include "job/job.h"
#include "output/product.h"
#include "usd/usd.h"

struct meshes {
    struct recipe recipe; /* of no frame yet */
    const struct job *job;
    double adaptivity; /* 0..1 voxels: how far the surface may move for fewer triangles */
    int smooth;        /* passes */
    bool rocks;        /* also mesh/NAME.rocks.FRAME, where the job has piles */
};

/* mesh/NAME.FRAME.ply, .obj and, of the surface, .usdc; a vertex' layer is that of the nearest particle, or of its height where the
 * frame has no points. */
MUST_USE status meshes_write(const struct meshes *m, int frame);

/* What their USD files have. */
void meshes_prim(const struct job *job, struct usd_prim *out);

/* Are they there, whole, made by this command of the frame that is there? E_MEMORY. */
MUST_USE status meshes_done(const struct meshes *m, int frame, bool *done);

#endif
