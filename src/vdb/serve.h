/* OpenVDB files in hoodoo-read (*_shim.cpp), and the parts of its answers. Each kind reads the whole file and detects damage.
 *
 * vdb.check                         no parts
 * vdb.describe, vdb.lattices        text, see vdb.h; arguments: reader/describe.h
 * vdb.volumes NAME...               struct vdb_part_volumes; the numbers of the frame's bricks; the values of each of its
 *                                   grids, floats, brick by brick (particles/grids.h)
 * vdb.points                        struct vdb_part_points; each field of particles.def that the file has
 * vdb.surface                       struct trimesh_lattice; its samples, floats: `surface` around its zero
 * vdb.at NORMALS OPTIONAL NAME...   input: positions float[n][3]. If NORMALS is 1, float[n][3] of `surface`; then for
 *                                   each name float[n], 0 for those of the last OPTIONAL that are not in the file.
 *                                   NAME.x, .y or .z: of a vector, in the simulator's axes
 * vdb.shape GRID ISO                as reader/mesh_part.h says
 */
#ifndef HOODOO_VDB_SERVE_H
#define HOODOO_VDB_SERVE_H

#include <stdint.h>

#include "job/values.h"
#include "particles/rock.h"
#include "reader/serve.h"

enum { VDB_PART_GRIDS = VALUES };

struct vdb_part_grid {
    uint32_t word; /* index of its name in the arguments */
    int32_t kind, components;
};

/* The lattice is in the simulator's axes. */
struct vdb_part_volumes {
    int32_t n[3];
    uint32_t n_grids;
    uint64_t n_bricks;
    double voxel, origin[3];
    struct vdb_part_grid grid[VDB_PART_GRIDS];
};

struct vdb_part_points {
    uint64_t n;
    uint32_t has[ROCK_FIELDS];
};

#ifdef __cplusplus
extern "C" {
#endif

MUST_USE status vdb_serve_check(const struct serve_question *question, struct serve_answer *answer);
MUST_USE status vdb_serve_describe(const struct serve_question *question, struct serve_answer *answer);
MUST_USE status vdb_serve_lattices(const struct serve_question *question, struct serve_answer *answer);
MUST_USE status vdb_serve_volumes(const struct serve_question *question, struct serve_answer *answer);
MUST_USE status vdb_serve_points(const struct serve_question *question, struct serve_answer *answer);
MUST_USE status vdb_serve_surface(const struct serve_question *question, struct serve_answer *answer);
MUST_USE status vdb_serve_shape(const struct serve_question *question, struct serve_answer *answer);
MUST_USE status vdb_serve_at(const struct serve_question *question, struct serve_answer *answer);

#ifdef __cplusplus
}
#endif
#endif
