/* Detail below the spacing. Triangles are subdivided, and vertices are moved along their normals by a function of position in metres and of
 * steepness. Walls get ledges along beds, and joints; roofs and floors stay smooth; loose rock becomes lumpy. No vertex moves by more than
 * 0.4 spacings, so that the surface does not cross itself, and detail stays in place as long as the rock does. */
#ifndef HOODOO_REFINE_H
#define HOODOO_REFINE_H

#include "job/job.h"
#include "vdb/vdb.h"

struct refine {
    const struct job *job; /* for its beds */
    double spacing;        /* m, between particles */
    int times;             /* number of subdivisions; each divides a triangle into four */
    size_t n_values;       /* per vertex of the mesh */
    int loose;             /* index of the value that is the share of loose rock, or -1 */
    size_t most;           /* upper limit of triangles */
};

/* In place. E_MEMORY. */
MUST_USE status refine_mesh(const struct refine *how, struct vdb_mesh *mesh);

#endif
