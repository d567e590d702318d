/* Paint: the job's changes to particles inside shapes. */
#ifndef HOODOO_PAINT_H
#define HOODOO_PAINT_H

#include "base/status.h"
#include "job/job.h"

struct paint_set;
MUST_USE status paint_create(const struct job *job, struct paint_set **out);
void paint_destroy(struct paint_set **set);

struct paint_values {
    double erodibility, interlock, viability; /* factors */
    int inert;
};

/* All entries laid over each other, at x; {1, 1, 1, 0} where nothing is painted. */
struct paint_values paint_at(const struct paint_set *set, const double x[3]);

#endif
