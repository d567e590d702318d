/* The attitude of beds: from a position to its height in the sequence of beds as it was deposited.
 *
 * Beds are deposited level, perhaps on older ones that were tilted and eroded; they are folded, tilted about the pivot, and then cut by
 * faults, the oldest first. A position is restored along the slips of the faults, the youngest first; the rest is a function of position:
 * the height across the tilted beds minus that of the folds.
 *
 *   x' = x - throw / sin(dip) * (down the dip)            for each fault below x
 *   s  = p_z + n . (x' - p) - sum of A sin(2 pi c . (x' - p) / L + phase)
 *
 * and, below an unconformity at height u,
 *
 *   s  becomes  u - eroded + cos(a) (s - u) + sin(a) (level direction of its dip) . (x' - p), but no more than u
 *
 * n is the normal of the tilted beds, p the pivot, c the level direction across a fold's axis. Without an attitude s is the height z,
 * bit for bit. Folds are similar folds (Ramsay, Folding and Fracturing of Rocks, 1967, class 2): s is in metres across the beds where
 * they are as deposited; where they are steep, a bed of s metres is s / |grad s| metres thick.
 */
#ifndef HOODOO_ATTITUDE_H
#define HOODOO_ATTITUDE_H

#include <stdbool.h>

#include "job/job.h"

/* Are beds level everywhere, s = z? */
bool attitude_is_level(const struct job *job);

/* The unit normal of the beds, upwards, without folds. */
void attitude_up(const struct job *job, double out[3]);

/* The height s at x, m; and its gradient, if `gradient` is not NULL. */
double attitude_height(const struct job *job, const double x[3], double gradient[3]);

/* The index of the stratum at x. */
size_t attitude_layer(const struct job *job, const double x[3]);

/* The factor of the faults' breccia on rates, in a cube of width h around x (lead.h). */
double attitude_breccia(const struct job *job, const double x[3], double h);

/* The unit normal, upwards or level, of a plane with this strike and dip. */
void attitude_normal(double strike_deg, double dip_deg, double normal[3]);

/* The share of a cube of width h in a zone of width `wide` along a plane, `from` metres away from the cube's centre. The cube is replaced
 * by an interval of length h: the depth of a cube across a plane of any direction has the same mean and variance. */
double attitude_share(double from, double wide, double h);

#endif
