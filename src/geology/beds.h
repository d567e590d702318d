/* Generated beds: a table of hardness by height in the sequence of beds.
 *
 * Thickness t and hardness H (the inverse of the rate) of bed i are lognormal and correlated:
 *
 *   t = mean exp(S a - S^2 / 2)        H = exp(s z - m)
 *   z = r a + sqrt(1 - r^2) (sqrt(1 - q) b + sqrt(2 q) sin(2 pi height / rhythm))
 *
 * a and b are standard normal, hashed from the seed and i, which counts upwards from from_m, or both ways from height 0 if there is no
 * from_m, so that no bed depends on the domain. m makes the mean of H over all beds 1.
 *
 * source   thicknesses: Talling, On the frequency distribution of turbidite thickness, Sedimentology 48, 2001
 */
#ifndef HOODOO_BEDS_H
#define HOODOO_BEDS_H

#include <stddef.h>

#include "base/status.h"
#include "job/job.h"

struct beds {
    size_t n;         /* segments, from edge[i] to edge[i + 1]; outside of them the hardness is 1 */
    double *edge;     /* [n + 1], m, ascending */
    double *hardness; /* [n] */
    double *sum;      /* [n + 1], m: integral of the hardness from edge[0] */
    size_t capacity;
};

/* The beds between two heights, m. Free with beds_destroy(). E_USAGE: there are more than a job may have. E_MEMORY. */
MUST_USE status beds_create(const struct job *job, double low, double high, struct beds *out);
void beds_destroy(struct beds *b);

/* The mean hardness between two heights, by which a front that crosses the beds is slowed: times add up. *along: the hardness for a front
 * that runs along the beds, which the softest lead; not more than the mean. */
double beds_hardness(const struct beds *b, double low, double high, double *along);

/* The factor of cross-bedding on rates at x, where s is `height`: the mean across h metres of laminae. */
double beds_cross(const struct job *job, const double x[3], double height, double h);

#endif
