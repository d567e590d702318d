/* Comparisons of the self-test. On a difference they return false and describe the first one in `why`. */
#ifndef HOODOO_SELFTEST_COMPARE_H
#define HOODOO_SELFTEST_COMPARE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "checkpoint/checkpoint.h"
#include "particles/frame.h"

enum { WHY_BYTES = 400 };

/* Compares two states bit for bit, with the same sections in the same order. */
bool same_state(const struct checkpoint *expected, const struct checkpoint *got, char why[WHY_BYTES]);

/* Compares n words of a kernel's output. */
bool same_words(const uint32_t *expected, const uint32_t *got, size_t n, char why[WHY_BYTES]);

/* Is `got` within `share` of `expected`? `what` names the number in `why`. NaN is never near. */
bool near_number(const char *what, double expected, double got, double share, char why[WHY_BYTES]);

/* Does the ledger balance, start = rock + deposit + fallen + left? */
bool balances(const struct ledger *ledger, char why[WHY_BYTES]);

/* Characteristic numbers of a small job's last frame. */
struct measure {
    struct ledger ledger;
    double volume_m3;
    double lost_m3;       /* since the start */
    double height_m;      /* mean height of the particles */
    double stress_p95_Pa; /* 95th percentile of |T|; 0 in models without stress */
};

/* Compares a measure with a recorded one: equal start, balanced ledger, and numbers within the tolerance between devices (compare.c). */
bool same_measure(const struct measure *recorded, const struct measure *got, char why[WHY_BYTES]);

/* The 95th percentile of |value|, [n]; 0 if n is 0. Reorders the values. */
double percentile_95(float *value, size_t n);

#endif
