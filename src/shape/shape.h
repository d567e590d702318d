/* One shape of the scene, placed: its signed distance in the world. */
#ifndef HOODOO_SHAPE_H
#define HOODOO_SHAPE_H

#include "meshinput/sdf.h"
#include "shape/function.h"
#include "shape/heightfield.h"
#include "shape/jointmap.h"
#include "shape/placement.h"
#include "shape/stroke.h"
#include "shape/terrain.h"

struct shape {
    enum job_shape kind;
    struct placement place;
    double min[3], max[3]; /* m, in the world; infinite for a plane */
    double own_m3;         /* what its file holds by the file's own measure; NAN: nothing says so */
    union {
        struct job_box box;
        struct job_sphere sphere;
        struct {
            double from[3], axis[3], length, radius[2]; /* axis: unit */
        } cylinder;
        struct {
            double normal[3], offset; /* unit; inside where x . normal <= offset */
        } plane;
        struct vdb_sdf *mesh; /* of SHAPE_VOLUME, too; already in the world: its vertices were placed */
        struct heightfield *heightfield;
        struct jointmap *jointmap;
        struct stroke *stroke;
        struct terrain_shape *terrain;
        struct function *function;
    } u;
};

/* `detail`, `reach`: as for solid_create(). E_USAGE: a degenerate shape. E_INPUT: its file. */
MUST_USE status shape_init(struct shape *shape, const struct job_node *node, const struct placement *place,
                           double detail, double reach);
void shape_deinit(struct shape *shape);

/* m, negative inside; the sign is exact, the size exact or less. */
double shape_distance(const struct shape *shape, const double x[3]);

/* Are all points of the world's box min..max in the shape? False where that takes more than its extents to tell. */
bool shape_holds_box(const struct shape *shape, const double min[3], const double max[3]);

/* Is the shape loose material at x? */
bool shape_loose(const struct shape *shape, const double x[3]);

#endif
