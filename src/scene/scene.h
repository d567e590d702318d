/* From the scene of a job to its first particles.
 *
 * The domain is divided into voxels of the particle spacing h, eight to a cell of the stress grid; voxel (i, j, k) is [i h, (i+1) h] x
 * [j h, (j+1) h] x [k h, (k+1) h] and has the number (k ny + j) nx + i. Each voxel that contains rock gets one particle. Its position is
 * the voxel's centre plus a jitter, a hash of (seed, voxel); its viability is the share of the voxel inside the shape, so that slanted
 * and offset faces start where the job has them at any spacing.
 */
#ifndef HOODOO_SCENE_H
#define HOODOO_SCENE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "job/job.h"
#include "particles/rock.h"

/* The number of voxels of the domain on each axis: even, at least 2. E_USAGE: more than 2^32 in all, with rows padded to multiples of 32. */
MUST_USE status scene_voxels(const struct job *job, int n[3]);

/* A solid: a CSG tree of the job, with its files read. Meshes are voxelised at `detail` metres (half a particle spacing is right).
 * Distances are useful up to `reach` metres from the surface and may stop growing there. E_USAGE: a shape has no inside. E_INPUT: a file
 * is missing, damaged or hostile. E_MEMORY. */
struct solid;
MUST_USE status solid_create(const struct job_node *node, double detail, double reach, struct solid **out);
void solid_destroy(struct solid **solid);

/* The volume measured in the file itself, m3 in the world: of a closed mesh by its triangles, of a heightfield by its pixels. NAN for open
 * meshes, and unless the solid is a single shape from a file. */
double solid_file_m3(const struct solid *solid);

/* The solid of child i of the node that `solid` was made of. */
const struct solid *solid_child(const struct solid *solid, size_t i);

/* Its bounding box, m: infinite where a plane does not bound it, min > max if it is empty. */
void solid_bounds(const struct solid *solid, double min[3], double max[3]);

struct solid_point {
    double distance; /* m, negative inside: exact in sign (0: inside), in size exact or a lower bound */
    int inert;       /* in a union: of any part that contains the point; outside, of the nearest part */
    int loose; /* a deposit. In a union: of all parts that contain the point; outside, of the nearest part */
};

/* Thread-safe. */
struct solid_point solid_at(const struct solid *solid, const double x[3]);

/* Whether the world box min..max, m, is outside or inside of the solid, judged by the extents of its shapes only; SOLID_SOME: undecided.
 * The answer holds for points in the box that are at least a billionth of its size away from its faces. */
enum solid_share { SOLID_NONE, SOLID_ALL, SOLID_SOME };
enum solid_share solid_in_box(const struct solid *solid, const double min[3], const double max[3]);

/* Samples the scene. Sets the STATE fields: particles in voxel order, ids in that order, the layer by the height in the sequence of beds;
 * structure (geology/), noise and paint are applied. Voxels of which less than 1/64 is rock get no particle. The same job gives the same
 * bits, with any number of threads.
 *
 * Noise   Rates are multiplied by exp(amplitude * n(P)), n of zero mean and unit variance (shape/noise.h).
 * Paint   Entries are blended over each other in order. An entry's weight is the product of its shape's falloff, its image, its
 *         mesh_attribute and its noise; at weight 1 its factor replaces what was painted before. A factor of 1 paints nothing. A particle is inert where the
 *         shape contains P and the weight is at least 1/2.
 * Beds    sources[].bed_m is removed from the scene along path_m.
 *
 * Free *rock with rock_free(). E_USAGE: there is no rock in the domain, or none on the ground. E_INPUT: a file is missing, damaged or
 * hostile. E_MEMORY, with the number of particles. */
MUST_USE status scene_sample(const struct job *job, struct rock *rock);

/* The same rock as a grid: each voxel's share of rock (0: air), and its rate_factor at the voxel's centre. Both arrays are the caller's,
 * [scene_voxels()]. If `floats`, rock need not be on the ground. Errors of scene_sample(). */
MUST_USE status scene_grid(const struct job *job, bool floats, float *share, float *factor);

/* Fails with E_USAGE: the lowest rock is at z = `lowest` m, above the ground. */
status scene_fail_floating(double lowest);

/* The effect of an edit. */
struct scene_edited {
    size_t added, carved; /* particles */
    double added_m3;      /* rock added, in new particles and in those that were filled up */
};

/* Applies the carve, add and paint of an edit, in this order, to the STATE fields of the rock, whose arrays are replaced.
 *
 * Carve   A particle loses the share of its voxel that is inside the shape, and is removed if less than 1/64 is left.
 * Add     An empty voxel gets a particle as in scene_sample(), without the scene's paint. In a voxel with less rock than the shape has
 *         there, the particle of the lowest id is filled up. New ids start at next_id.
 * Paint   Factors multiply the particles' present ones.
 *
 * `job` is the job as of that frame. Errors of scene_sample(). */
MUST_USE status scene_edit(const struct job *job, const struct job_edit *edit, uint64_t next_id,
                           struct rock *rock, struct scene_edited *out);

/* Reads all files and makes all shapes of the edits after `frame`, so that errors are reported before the run starts. */
MUST_USE status scene_edits_check(const struct job *job, int frame);

/* An estimate of the particles that scene_sample() and the edits will make, from a quarter of a million voxels of each. */
enum { SCENE_NEAR = 8 };
struct scene_size {
    size_t n_particles;
    size_t n_surface; /* particles with a face to the air */
    size_t n_near;    /* particles within SCENE_NEAR voxels of the surface */
    size_t n_ends;    /* ends of runs of particles along x */
    size_t n_kept;    /* particles that a run stores: n_particles unless the model says otherwise */
    size_t n_points;
    float (*point)
        [3]; /* m: the centres of the sampled voxels that are rock, in any order; the caller frees it */
};

/* Errors of files and shapes as in scene_sample(); an empty scene has 0 particles. */
MUST_USE status scene_estimate(const struct job *job, struct scene_size *out);

/* Bounds of the sampled points, m; low > high if there are none. */
void scene_bounds(const struct scene_size *size, double low[3], double high[3]);

/* A shape of the scene that comes from a file. */
struct scene_input {
    const char *file;      /* belongs to the job */
    double file_m3;        /* solid_file_m3(): as the file itself has it */
    double sampled_m3;     /* the volume sampled at the job's spacing, within about a percent */
    double min[3], max[3]; /* m: its bounds in the world */
};

/* The sentence about a file's volume, by its own measure and as it is sampled every h m, and its bounds. True: the volumes differ by more than
 * 5 %. */
bool scene_input_text(const struct scene_input *input, double h, char text[600]);

/* Logs the sentence about each file of the job's scene, whose solid is `scene`, once per process. E_MEMORY. */
struct solid;
MUST_USE status scene_log_inputs(const struct job *job, const struct solid *scene);

/* What the checks before a run look at, from one reading of the scene's files. */
struct scene_survey {
    struct scene_size size;
    struct solid *solid; /* the scene without its river beds; NULL: the job has no scene */
    struct scene_input *input;
    size_t n_inputs;
};

/* Free *out with scene_survey_free(). Errors as scene_estimate(). */
MUST_USE status scene_survey(const struct job *job, struct scene_survey *out);
void scene_survey_free(struct scene_survey *survey);

/* Fails as scene_sample() does, or scene_grid() with `floats`, without sampling the whole scene. E_USAGE: there is no rock in the
 * domain, or none on the ground. */
MUST_USE status scene_check(const struct job *job, bool floats, const struct scene_survey *survey);

/* Reads the files that scene_survey() does not: of paint, and of what edits carve and paint. Errors of scene_sample(). */
MUST_USE status scene_paint_check(const struct job *job);

#endif
