#include "selftest/compare.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool same_words(const uint32_t *expected, const uint32_t *got, size_t n, char why[WHY_BYTES])
{
    for (size_t i = 0; i < n; i++)
        if (expected[i] != got[i]) {
            snprintf(why, WHY_BYTES, "item %zu of %zu is 0x%08" PRIx32 " and should be 0x%08" PRIx32, i, n,
                     got[i], expected[i]);
            return false;
        }
    return true;
}

static bool same_section(const struct checkpoint_section *a, const struct checkpoint_section *b,
                         char why[WHY_BYTES])
{
    if (strcmp(a->name, b->name) != 0 || a->item != b->item || a->n != b->n) {
        snprintf(why, WHY_BYTES, "%zu items of %zu bytes in '%s', where there were %zu of %zu in '%s'", b->n,
                 b->item, b->name, a->n, a->item, a->name);
        return false;
    }
    const unsigned char *x = a->data, *y = b->data;
    for (size_t i = 0; i < a->n * a->item; i++)
        if (x[i] != y[i]) {
            snprintf(why, WHY_BYTES, "byte %zu of item %zu of %zu in '%s' is 0x%02x and was 0x%02x",
                     i % a->item, i / a->item, a->n, a->name, y[i], x[i]);
            return false;
        }
    return true;
}

bool same_state(const struct checkpoint *expected, const struct checkpoint *got, char why[WHY_BYTES])
{
    if (expected->frame != got->frame || memcmp(&expected->years, &got->years, sizeof got->years) != 0 ||
        expected->n_sections != got->n_sections) {
        snprintf(why, WHY_BYTES, "frame %d after %g years with %zu sections, where there was %d, %g, %zu",
                 got->frame, got->years, got->n_sections, expected->frame, expected->years,
                 expected->n_sections);
        return false;
    }
    for (size_t i = 0; i < expected->n_sections; i++)
        if (!same_section(&expected->section[i], &got->section[i], why))
            return false;
    return true;
}

bool near_number(const char *what, double expected, double got, double share, char why[WHY_BYTES])
{
    if (fabs(got - expected) <= share * fabs(expected))
        return true;
    snprintf(why, WHY_BYTES, "%s is %.6g and should be %.6g within %.3g %%", what, got, expected,
             100 * share);
    return false;
}

bool balances(const struct ledger *l, char why[WHY_BYTES])
{
    if (l->start == l->rock + l->deposit + l->fallen + l->left)
        return true;
    snprintf(why, WHY_BYTES,
             "the ledger began with %" PRIu64 " and has %" PRIu64 " rock, %" PRIu64 " deposit, %" PRIu64
             " fallen, %" PRIu64 " left",
             l->start, l->rock, l->deposit, l->fallen, l->left);
    return false;
}

/* Devices round in the same way but fuse multiplications and additions differently, which changes the last bits of a number. A relative change
 * of 1e-6 in a rate or strength moves no particle in these jobs, or at most one of thousands by a frame. A kernel that misses a neighbour,
 * or a process that does not run, changes these numbers by percents. */
static const double VOLUME = 0.005, LOST = 0.02, HEIGHT = 0.002, STRESS = 0.01;

bool same_measure(const struct measure *recorded, const struct measure *got, char why[WHY_BYTES])
{
    if (!balances(&got->ledger, why))
        return false;
    if (recorded->ledger.start != got->ledger.start) {
        snprintf(why, WHY_BYTES, "the scene has %" PRIu64 " to begin with and should have %" PRIu64,
                 got->ledger.start, recorded->ledger.start);
        return false;
    }
    return near_number("the volume, m3,", recorded->volume_m3, got->volume_m3, VOLUME, why) &&
           near_number("the volume lost, m3,", recorded->lost_m3, got->lost_m3, LOST, why) &&
           near_number("the mean height, m,", recorded->height_m, got->height_m, HEIGHT, why) &&
           near_number("the stress, Pa,", recorded->stress_p95_Pa, got->stress_p95_Pa, STRESS, why);
}

static int by_value(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

double percentile_95(float *value, size_t n)
{
    if (n == 0)
        return 0;
    for (size_t i = 0; i < n; i++)
        value[i] = fabsf(value[i]);
    qsort(value, n, sizeof *value, by_value);
    return (double)value[(size_t)(0.95 * (double)(n - 1))];
}
