/* Paint: changes to the properties of particles, masked by a shape, an image, values of a mesh and noise. */
#ifndef HOODOO_PAINT_H
#define HOODOO_PAINT_H

#include <stdbool.h>

#include "base/status.h"
#include "job/job.h"

struct paint_set;

/* The n entries of a list of the job. Job and entries must outlive the set. Errors of solid_create(), image_read() and
 * vertex_paint_create(). */
MUST_USE status paint_create(const struct job *job, const struct job_paint *entry, size_t n,
                             struct paint_set **out);
void paint_destroy(struct paint_set **set);

/* Images with a depth_m need to know which rock is in front: if paint_needs_occluders(), call paint_add_occluder() for every particle
 * before the first paint_at(). Not thread-safe. */
bool paint_needs_occluders(const struct paint_set *set);
void paint_add_occluder(struct paint_set *set, const double x[3]);

struct paint_values {
    double erodibility, interlock, viability; /* factors */
    double vegetation;                        /* share of the ground, 0..1 */
    int inert;
};

/* All entries applied in order at x, where plants cover `vegetation` of the ground before. {1, 1, 1, vegetation, 0} where nothing is
 * painted. Thread-safe. */
struct paint_values paint_at(const struct paint_set *set, const double x[3], double vegetation);

#endif
