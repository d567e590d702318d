/* USD of a sequence: a stage as text, and the rock's surface as points in crate files. Written by hand: USD's
 * own library is no part of hoodoo.
 *
 * NAME.usda          the stage (usd_stage): the volumes' VDBs as OpenVDBAsset fields, meshes and points as value
 *                    clips, the cameras, sun and sky (usd_lights). Where there are meshes they are what is rendered: the volumes are invisible and points
 *                    are a proxy
 * points/NAME.1001.usdc      one frame's surface particles (usd_points), as a Points prim </points>
 * points/NAME.clips.usda     what these files may hold (usd_clips): USD's manifest of the clips
 * mesh/NAME.1001.usdc        one frame's surface (usd_mesh), as a Mesh prim </surface>; mesh/NAME.clips.usda
 * rocks/NAME.1001.usdc       one frame's rocks (usd_rocks), as a PointInstancer </rocks>; rocks/NAME.clips.usda
 * rocks/NAME.shapes.usda     their shapes (usd_shapes), which the stage has as the instancer's prototypes
 *
 * Units     Metres: metersPerUnit is 1. Axes are the files' (output.up). USD measures film in tenths of the
 *           scene's unit, so focal lengths and apertures are in decimetres; widths of points are diameters.
 * Bytes     Equal input gives equal bytes.
 * Source    openusd.org: "USD Specification" of .usda; usdVol and usdGeom schemas; crate files as
 *           pxr/usd/usd/crateFile.cpp reads them, version 0.8.0, which USD from 19.03 on can.
 */
#ifndef HOODOO_USD_H
#define HOODOO_USD_H

#include "base/text.h"
#include "output/mesh_file.h"
#include "particles/rock.h"
#include "usd/crate.h"
#include "vdb/vdb.h"

/* A camera at one frame. Axes of the files. */
struct usd_key {
    int frame;
    double to_world[16]; /* row vectors times matrix; the camera looks along -z, y is up */
    double focal_mm;
};

struct usd_camera {
    const char *name; /* made a prim's name: other characters than letters and digits become _ */
    double width_mm, height_mm;
    size_t n_keys; /* ascending frames; what is alike in all is written once */
    const struct usd_key *key;
};

/* Sun and sky at one frame. Colours are scene-linear: what a white surface sends back of them. */
struct usd_light {
    int frame;
    double to_world[16]; /* as a camera's: the sun shines along -z. Axes of the files */
    double sun[3];       /* on a surface that faces it */
    double sky[3];       /* on one that faces the whole dome */
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
    const int *volumes_frame; /* those there are, ascending */
    const int *meshes_frame;
    struct usd_prim mesh; /* what their files have */
    const int *points_frame;
    const int *rocks_frame;
    size_t n_shapes; /* of rocks */
    const struct usd_camera *camera;
    size_t n_lights; /* 0: none; 1: the same in all frames; else one a frame, ascending */
    const struct usd_light *light;
};

void usd_stage(const struct usd_sequence *s, struct text *out);
/* The part of the stage that lights it: a DistantLight whose intensity is the irradiance on what faces it, and a DomeLight of one
 * colour. */
void usd_lights(const struct usd_sequence *s, struct text *out);
void usd_clips(const struct usd_sequence *s, const struct usd_prim *prim, struct text *out);

/* The particles with a normal: positions, normals, widths, ids, the layer's colour, and as primvars the values
 * that are fields (IN_USD of values.def). out->bytes is freed with free(). E_OUTPUT: more than a file can number. */
MUST_USE status usd_points(const struct rock *rock, const struct vdb_options *options, double fps,
                           struct vdb_bytes *out);

/* What files of such meshes have: `value` are names of values. */
void usd_mesh_prim(const char *const *value, size_t n, bool moves, struct usd_prim *out);

/* Triangles: points, normals, the layer's colour, velocities of what moves, and the values as primvars. out->bytes is freed with
 * free(). */
MUST_USE status usd_mesh(const struct mesh_file *mesh, int frame, double fps, struct vdb_bytes *out);

/* The rocks: positions, shapes, ids that stay with a rock, no turns. As above. */
MUST_USE status usd_rocks(const struct frame_rocks *rocks, const struct vdb_options *options, double fps,
                          struct vdb_bytes *out);

/* What rocks look like: closed meshes around their positions, in the simulator's axes, m. */
struct usd_shape {
    size_t n_vertices;            /* 1 and more */
    const float *vertex, *normal; /* [n_vertices][3] */
};
struct usd_shapes {
    int up;
    size_t n, n_triangles;
    const struct usd_shape *shape;
    const uint32_t *triangle; /* [n_triangles][3], of every shape */
    float color[3];           /* linear */
};

void usd_shapes(const struct usd_shapes *s, struct text *out);

#endif
