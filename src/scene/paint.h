/* Paint: a job's changes to particles, by shape, image and noise. */
#ifndef HOODOO_PAINT_H
#define HOODOO_PAINT_H

#include <stdbool.h>

#include "base/status.h"
#include "job/job.h"

struct paint_set;

/* The n entries of a list, for particles of this job; both are borrowed. */
MUST_USE status paint_create(const struct job *job, const struct job_paint *entry, size_t n,
                             struct paint_set **out);
void paint_destroy(struct paint_set **set);

/* Images that reach only so deep must be shown every particle first: if paint_sees(), call paint_see() for each
 * before the first paint_at(), one at a time. */
bool paint_sees(const struct paint_set *set);
void paint_see(struct paint_set *set, const double x[3]);

struct paint_values {
    double erodibility, interlock, viability; /* factors */
    double vegetation;
    int inert;
};

/* All entries laid over each other, at x, where plants cover `vegetation` of the ground; {1, 1, 1, vegetation, 0}
 * where nothing is painted. */
struct paint_values paint_at(const struct paint_set *set, const double x[3], double vegetation);

#endif
