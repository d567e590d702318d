/* What turns voxels into particles: inside src/scene only. */
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
    struct noise *noise; /* by layer */
    uint32_t jitter[3];  /* what each axis hashes with */
};

/* Of the scene, beds taken out; or of one shape, `node`. `reach`: how far from the surface distances will be asked
 * for, in spacings. */
MUST_USE status sampler_init(struct sampler *s, const struct job *job, const struct job_node *node,
                             double reach);

/* What sampling needs beside the shape, with these n entries of paint. */
MUST_USE status sampler_fill(struct sampler *s, const struct job_paint *paint, size_t n);
void sampler_deinit(struct sampler *s);

/* Is there rock, and unless it `floats` on the ground? E_USAGE if not. */
MUST_USE status sampler_check(const struct sampler *s, bool floats);

/* Where a voxel's particle sits: its middle and a jitter that depends on the seed and the voxel alone. */
void sampler_place(const struct sampler *s, const int voxel[3], float P[4]);

/* What the structure of the rock makes of a voxel's. */
struct structure_rock sampler_structure(const struct sampler *s, const int voxel[3]);

/* What paint and noise multiply the rates of the rock at x, of this layer, with; 0: inert. */
double sampler_rate_factor(const struct sampler *s, size_t layer, const double x[3],
                           const struct paint_values *paint);

/* Shows the paint every particle, if it wants to see them. */
void sampler_see(const struct sampler *s, const struct rock *rock);

void rock_position(const struct rock *rock, size_t p, double x[3]);

#endif
