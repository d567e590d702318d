/* How beds lie: from a place to its height in the pile of beds as it was laid down.
 *
 * Beds are laid down level, perhaps on older ones that were tilted and worn down; they are folded, tilted about the pivot, and then cut by
 * faults, the oldest first. So a place is taken back
 * along the faults' slips, the youngest first, and what is left is a function of place: the tilted height less that of the folds.
 *
 *   x' = x - throw / sin(dip) * (down the dip)            for each fault below x
 *   s  = p_z + n . (x' - p) - sum of A sin(2 pi c . (x' - p) / L + phase)
 *
 * and, below an unconformity at height u,
 *
 *   s  becomes  u - eroded + cos(a) (s - u) + sin(a) (level direction of its dip) . (x' - p), but no more than u
 *
 * n is the normal of the tilted beds, p the pivot, c the level direction across a fold's axis. Without an attitude s is the height z,
 * to the bit. Folds are similar ones (Ramsay, Folding and Fracturing of Rocks, 1967, class 2): s is metres across the beds where
 * they lie as they were laid, and 1 / |grad s| metres where they are steep.
 */
#ifndef HOODOO_ATTITUDE_H
#define HOODOO_ATTITUDE_H

#include <stdbool.h>

#include "job/job.h"

/* Whether beds are level everywhere: their height is z. */
bool attitude_is_level(const struct job *job);

/* The unit normal of the beds, upwards, but for folds. */
void attitude_up(const struct job *job, double out[3]);

/* A place's height in the pile, m. With `gradient`, its gradient there, too. */
double attitude_height(const struct job *job, const double x[3], double gradient[3]);

/* The index of the stratum at a place. */
size_t attitude_layer(const struct job *job, const double x[3]);

/* What the breccia of the faults multiplies rates with, in a cube of the width h around x (lead.h). */
double attitude_breccia(const struct job *job, const double x[3], double h);

/* Of a plane with this strike and dip, in degrees: its unit normal, upwards or level. */
void attitude_normal(double strike_deg, double dip_deg, double normal[3]);

/* The share of a cube of the width h that lies in a zone of the width `wide` along a plane, whose middle is `from` m away: that of an
 * interval which is h long. A cube's own depth across a plane, whatever its direction, has the same mean and variance. */
double attitude_share(double from, double wide, double h);

#endif
