/* Detail below the spacing: the mesh's triangles are cut finer, and their corners moved along the normals by a function of the place in
 * metres and of how steep the rock is there. Walls have ledges by beds, and joints; roofs and floors have none; loose rock is lumpy.
 * Nothing is moved farther than 0.4 spacings, so that nothing crosses, and where the rock stays its detail does. */
#ifndef HOODOO_REFINE_H
#define HOODOO_REFINE_H

#include "job/job.h"
#include "vdb/vdb.h"

struct refine {
    const struct job *job; /* its beds */
    double spacing;        /* m, of the particles */
    int times;             /* each cuts a triangle into four */
    size_t n_values;       /* of the mesh */
    int loose;             /* the value that says loose rock, or -1 */
    size_t most;           /* triangles: it stops cutting before there are more */
};

/* In place. E_MEMORY. */
MUST_USE status refine_mesh(const struct refine *how, struct vdb_mesh *mesh);

#endif
