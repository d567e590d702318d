/* A frame's meshes, from its files: the surface, and the rocks that lie on it in piles. */
#ifndef HOODOO_MESHES_H
#define HOODOO_MESHES_H

#include <stdbool.h>

#include "job/job.h"

struct meshes {
    const char *root; /* the output folder */
    const struct job *job;
    double adaptivity; /* 0..1 voxels: how far the surface may move for fewer triangles */
    int smooth;        /* passes */
    bool rocks;        /* also mesh/NAME.rocks.FRAME, where the job has piles */
};

/* mesh/NAME.FRAME.ply and .obj; a vertex' layer is that of the nearest particle, or of its height where the
 * frame has no points. */
MUST_USE status meshes_write(const struct meshes *m, int frame);

/* Are they there, no older than what they are made from? */
bool meshes_current(const struct meshes *m, int frame);

#endif
