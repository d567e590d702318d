/* Concretions and lenses: rock that a cement has made harder, as ellipsoids that lie in the beds.
 *
 * Space is cut into cubes, and each has as many as a Poisson distribution of the density gives it, by hashes of the seed and the
 * cube; so that none depends on the domain. Radii are lognormal. They act on rates in the mean over a cube: time adds up.
 */
#ifndef HOODOO_CONCRETIONS_H
#define HOODOO_CONCRETIONS_H

#include "job/job.h"

/* In a cube (concretions_cube()) on average: beyond, rock would take too long to make. */
enum { CONCRETIONS_MOST = 100 };

/* How many times more slowly rock weathers for them, in the mean over a cube of the width h around x, where the pile's height is
 * `height`; 1: there are none. */
double concretions_hardness(const struct job *job, const double x[3], double height, double h);

/* Those of list entry `i` whose middles lie in a box; middle and level radius of each, 4 numbers. At most `most`; how many there are. */
size_t concretions_in(const struct job *job, size_t i, const double low[3], const double high[3],
                      double (*out)[4], size_t most);

/* The side of the cubes of an entry, m, and how many concretions one has on average. */
double concretions_cube(const struct job_concretion *c, double *count);

#endif
