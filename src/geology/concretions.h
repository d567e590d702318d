/* Concretions and lenses: rock hardened by a cement, as ellipsoids that are parallel to the beds.
 *
 * Space is divided into cubes. The number of concretions of a cube has a Poisson distribution, by hashes of the seed and the cube, so
 * that none depends on the domain. Radii are lognormal. Rates get the mean hardness of a cube of rock, for times add up.
 */
#ifndef HOODOO_CONCRETIONS_H
#define HOODOO_CONCRETIONS_H

#include "job/job.h"

/* The largest average number in a cube (concretions_cube()); with more, making rock would take too long. */
enum { CONCRETIONS_MAX = 100 };

/* The factor by which they slow down weathering: the mean over a cube of width h around x, where s is `height`; 1: there are none. */
double concretions_hardness(const struct job *job, const double x[3], double height, double h);

/* Finds the concretions of list entry i with their centres in a box: writes centre and level radius of up to `most` to out[][4] and returns
 * the number of all. */
size_t concretions_in(const struct job *job, size_t i, const double low[3], const double high[3],
                      double (*out)[4], size_t most);

/* The side of the cubes of an entry, m; *count: the average number of concretions in one. */
double concretions_cube(const struct job_concretion *c, double *count);

#endif
