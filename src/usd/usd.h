/* USD files of a sequence: the stage as text, and points, meshes and rocks as crate files. hoodoo writes them itself, without USD's
 * library.
 *
 * NAME.usda          the stage (usd_stage): the volumes' VDBs as OpenVDBAsset fields, meshes and points as value clips, cameras, sun and
 *                    sky (usd_lights). If there are meshes, they are rendered, the volumes are invisible and the points are a proxy
 * points/NAME.1001.usdc      one frame's surface particles (usd_points), as a Points prim </points>
 * points/NAME.clips.usda     declares the attributes of these files (usd_clips): USD's manifest of the clips
 * mesh/NAME.1001.usdc        one frame's surface (usd_mesh), as a Mesh prim </surface>; mesh/NAME.clips.usda
 * rocks/NAME.1001.usdc       one frame's rocks (usd_rocks), as a PointInstancer </rocks>; rocks/NAME.clips.usda
 * rocks/NAME.shapes.usda     the shapes of rocks (usd_shapes), which the stage references as the instancer's prototypes
 *
 * Units     Metres: metersPerUnit is 1. The axes are the files' (output.up). USD measures focal lengths and apertures in tenths of the
 *           scene's unit, here decimetres. Widths of points are diameters.
 * Bytes     Equal input gives equal bytes.
 * Source    openusd.org: "USD Specification" of .usda; usdVol and usdGeom schemas; crate files as
 *           pxr/usd/usd/crateFile.cpp reads them, version 0.8.0, which USD from 19.03 on can.
 */
#ifndef HOODOO_USD_H
#define HOODOO_USD_H

#include "output/mesh_file.h"
#include "particles/rock.h"
#include "text/text.h"
#include "usd/crate.h"
#include "vdb/vdb.h"

/* A camera at one frame, in the files' axes. */
struct usd_key {
    int frame;
    double to_world[16]; /* for row vectors; the camera looks along -z, y is up */
    double focal_mm;
};

struct usd_camera {
    const char *name;           /* characters other than letters and digits become _ in the prim's name */
    double width_mm, height_mm; /* of the film */
    size_t n_keys;
    const struct usd_key *key; /* by ascending frame; values that are equal in all are written once */
};

/* Sun and sky at one frame. Colours are scene-linear: the radiance that a white surface reflects. */
struct usd_light {
    int frame;
    double to_world[16]; /* as a camera's, in the files' axes; the sun shines along -z */
    double sun[3];       /* on a surface that faces the sun */
    double sky[3];       /* on a surface lit by the whole dome */
};

/* A grid of the volumes. */
struct usd_field {
    char name[64];
    enum grid_class kind;
    bool vector;
};

struct usd_sequence {
    const char *name;
    int first, last; /* frames of the job */
    double fps;
    bool moves; /* points have velocities */
    int up;     /* OUTPUT_UP_* */
    size_t n_fields, n_volumes, n_meshes, n_points, n_rocks, n_cameras;
    const struct usd_field *field;
    double low[3], high[3];   /* m: the box of all fields, in the files' axes */
    const int *volumes_frame; /* the frames that have volumes, ascending; likewise those below */
    const int *meshes_frame;
    struct usd_prim mesh; /* the attributes of mesh files */
    const int *points_frame;
    const int *rocks_frame;
    size_t n_shapes; /* of rocks */
    const struct usd_camera *camera;
    size_t n_lights; /* 0: none; 1: the same in all frames; otherwise one per frame, ascending */
    const struct usd_light *light;
};

void usd_stage(const struct usd_sequence *s, struct text *out);
/* Adds the lights of the stage: a DistantLight whose intensity is the irradiance on a surface facing it, and a DomeLight of uniform
 * colour. */
void usd_lights(const struct usd_sequence *s, struct text *out);
void usd_clips(const struct usd_sequence *s, const struct usd_prim *prim, struct text *out);

/* The surface particles (those with a normal): positions, normals, widths, ids, the layer's colour, and as primvars the fields that are
 * IN_USD in values.def. On an error the caller drops the draft. E_OUTPUT: too many particles for a file. */
MUST_USE status usd_points(const struct rock *rock, const struct vdb_options *options, double fps,
                           struct draft *out);

/* The prim of mesh files with these values, given by name; `moves`: with velocities. */
void usd_mesh_prim(const char *const *value, size_t n, bool moves, struct usd_prim *out);

/* A mesh: points, triangles, normals, the layer's colour, velocities if rock moves, and the values as primvars. */
MUST_USE status usd_mesh(const struct mesh_file *mesh, int frame, double fps, struct draft *out);

/* The rocks: positions, shapes, ids that stay the same through all frames, and identity orientations. */
MUST_USE status usd_rocks(const struct frame_rocks *rocks, const struct vdb_options *options, double fps,
                          struct draft *out);

/* The shapes of rocks: closed meshes around their positions, in the simulator's axes, m. */
struct usd_shape {
    size_t n_vertices;            /* at least 1 */
    const float *vertex, *normal; /* [n_vertices][3] */
};
struct usd_shapes {
    int up;
    size_t n, n_triangles;
    const struct usd_shape *shape;
    const uint32_t *triangle; /* [n_triangles][3], the same for every shape */
    float color[3];           /* linear */
};

void usd_shapes(const struct usd_shapes *s, struct text *out);

#endif
