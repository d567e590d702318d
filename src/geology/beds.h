/* Beds that are made: a table of how hard the pile is, by height.
 *
 * Thickness t and hardness H, one over the rate, of bed i are lognormal and correlated:
 *
 *   t = mean exp(S a - S^2 / 2)        H = exp(s z - m)
 *   z = r a + sqrt(1 - r^2) (sqrt(1 - q) b + sqrt(2 q) sin(2 pi height / rhythm))
 *
 * a and b are normal, hashed from the seed and i, which counts from from_m upwards, or from height 0 both ways where the pile has
 * no foot: no bed depends on the domain. m makes the mean of H over the pile 1.
 *
 * source   thicknesses: Talling, On the frequency distribution of turbidite thickness, Sedimentology 48, 2001
 */
#ifndef HOODOO_BEDS_H
#define HOODOO_BEDS_H

#include <stddef.h>

#include "base/status.h"
#include "job/job.h"

struct beds {
    size_t n;         /* segments, from edge[i] to edge[i + 1]; beyond all of them hardness is 1 */
    double *edge;     /* m [n + 1], ascending */
    double *hardness; /* [n] */
    double *sum;      /* m [n + 1]: of hardness times thickness from edge[0] on */
    size_t capacity;
};

/* Those between two heights. E_USAGE: they would be more than a job may have. */
MUST_USE status beds_create(const struct job *job, double low, double high, struct beds *out);
void beds_destroy(struct beds *b);

/* Hardness in the mean over heights from low to high, which is how long a front takes from one to the other: time adds up across
 * beds. And the hardness that they have to a front along them, which the softest lead: no more than that. */
double beds_hardness(const struct beds *b, double low, double high, double *along);

/* What cross-bedding multiplies rates with at x, where the pile's height is `height`, in the mean across h metres of laminae. */
double beds_cross(const struct job *job, const double x[3], double height, double h);

#endif
