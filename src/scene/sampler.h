/* From voxels to particles. Private to src/scene. */
#ifndef HOODOO_SAMPLER_H
#define HOODOO_SAMPLER_H

#include "geology/structure.h"
#include "job/job.h"
#include "particles/rock.h"
#include "scene/coverage.h"
#include "scene/paint.h"
#include "scene/scene.h"
#include "shape/noise.h"

struct sampler {
    const struct job *job;
    int n[3];
    double h;
    struct solid *solid;
    struct coverage *coverage;
    struct paint_set *paint;
    struct structure structure;
    struct noise *noise; /* [n_strata + 1] */
    uint32_t jitter[3];  /* hash seed of each axis */
};

/* Makes the solid: of the shape `node`, or if NULL of the job's scene without its river beds. `reach`: how far from the surface distances
 * are needed, in spacings. Free with sampler_deinit(), also on error. Errors of solid_create(). */
MUST_USE status sampler_init(struct sampler *s, const struct job *job, const struct job_node *node,
                             double reach);

/* Makes coverage, structure, noise and paint, with these n entries of paint. Errors of paint_create(). */
MUST_USE status sampler_prepare(struct sampler *s, const struct job_paint *paint, size_t n);
void sampler_deinit(struct sampler *s);

/* Adds the inputs of the job's scene to *out; `scene`: its solid. E_MEMORY. */
MUST_USE status inputs_measure(const struct job *job, const struct solid *scene, struct scene_survey *out);

/* Of a sampler of the job's scene: its solid without the river beds. */
const struct solid *sampler_scene(const struct sampler *s);

/* E_USAGE: there is no rock in the domain, or, unless it may float, none on the ground. */
MUST_USE status sampler_check(const struct sampler *s, bool floats);

/* The position of a voxel's particle: its centre plus, unless the model wants centres, a jitter that depends on seed and voxel only.
 * P[3] = 0. */
void sampler_position(const struct sampler *s, const int voxel[3], float P[4]);

/* The effect of the geological structure on a voxel. */
struct structure_rock sampler_structure(const struct sampler *s, const int voxel[3]);

/* The factor of paint and noise on all rates of the rock at x, of this layer; 0: inert. */
double sampler_rate_factor(const struct sampler *s, size_t layer, const double x[3],
                           const struct paint_values *paint);

/* Adds every particle as an occluder, if the paint needs them. */
void sampler_add_occluders(const struct sampler *s, const struct rock *rock);

void rock_position(const struct rock *rock, size_t p, double x[3]);

#endif
