/* Dimensionless groups of a job: the ratios on which its forms depend, and where they stand against the ranges in which forms emerge.
 *
 *   interlocking   I / (density g H): the interlocking stress over the weight of the rock above a stratum's foot (Arenite eq. 2)
 *   retreat        R t / (W / 2): the retreat of bare rock in the job's time over half the width of the rock
 *   endurance      k_s t / (W / 2): the same for interlocked rock
 *   deflation      mu_f T / alpha at the foot: how much load keeps the wind from plucking grains (Arenite eq. 12)
 *   abrasion       R_a / R_d: blown sand over plucking, on a face to the wind (Arenite eq. 8)
 *   water          k_f q^0.6 / tau_c: shear of the water on a slope of 1 over what the rock withstands (Arenite eq. 14)
 *   bubble         r / (W / 2): radius of the bubble over half the width of the rock (Goblins 5)
 */
#ifndef HOODOO_RUN_GROUPS_H
#define HOODOO_RUN_GROUPS_H

#include "job/job.h"
#include "scene/scene.h"

/* Adds the array "groups" to a JSON object: per group its `group`, `formula`, `value`, the range `forms_from` to `forms_to` of the
 * examples in jobs/ (0: no bound), and `says`, a sentence with numbers. Models without such groups, and scenes without rock, add
 * nothing. */
void groups_describe(const struct job *job, const struct scene_size *size, struct text *t);

#endif
