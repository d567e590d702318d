/* A shape, a leaf of the scene's CSG tree, with its placement: a signed distance in world space. */
#ifndef HOODOO_SHAPE_H
#define HOODOO_SHAPE_H

#include "meshinput/sdf.h"
#include "shape/function.h"
#include "shape/heightfield.h"
#include "shape/jointmap.h"
#include "shape/placement.h"
#include "shape/stroke.h"
#include "shape/terrain.h"
#include "shape/voxel_shape.h"

struct shape {
    enum job_shape kind;
    struct placement place;
    double min[3], max[3]; /* m, in the world; infinite for a plane */
    double file_m3; /* m3 in the world, as the file itself has it (closed mesh, heightfield); NAN: unknown */
    union {
        struct job_box box;
        struct job_sphere sphere;
        struct {
            double from[3], axis[3], length, radius[2]; /* axis: unit */
        } cylinder;
        struct {
            double normal[3], offset; /* unit; inside where x . normal <= offset */
        } plane;
        struct vdb_sdf *
            mesh; /* SHAPE_MESH, SHAPE_VOLUME: in world space, for its vertices are transformed when it is read */
        struct heightfield *heightfield;
        struct jointmap *jointmap;
        struct stroke *stroke;
        struct terrain_shape *terrain;
        struct voxel_shape *voxels;
        struct function *function;
    } u;
};

/* Makes the shape of `node` and reads its file. `detail`, `reach`: as for solid_create(). Free with shape_deinit(), also on error.
 * E_USAGE: a degenerate shape. E_INPUT: its file. E_MEMORY. */
MUST_USE status shape_init(struct shape *shape, const struct job_node *node, const struct placement *place,
                           double detail, double reach);
void shape_deinit(struct shape *shape);

/* m, negative inside: exact in sign, in size exact or a lower bound. Thread-safe. */
double shape_distance(const struct shape *shape, const double x[3]);

/* Is the world box min..max surely inside the shape? Only known for boxes; false for all other kinds. */
bool shape_holds_box(const struct shape *shape, const double min[3], const double max[3]);

/* Is the shape loose material at x? */
bool shape_loose(const struct shape *shape, const double x[3]);

#endif
