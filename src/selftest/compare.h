/* What a self-test goes by: comparisons that can say no. Each describes the first difference in `why` and returns false. */
#ifndef HOODOO_SELFTEST_COMPARE_H
#define HOODOO_SELFTEST_COMPARE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "checkpoint/checkpoint.h"
#include "particles/frame.h"

enum { WHY_BYTES = 400 };

/* Two states, bit for bit: the same sections in the same order. */
bool same_state(const struct checkpoint *expected, const struct checkpoint *got, char why[WHY_BYTES]);

/* n words of what a kernel made. */
bool same_words(const uint32_t *expected, const uint32_t *got, size_t n, char why[WHY_BYTES]);

/* A number `what` that may differ from the expected one by `share` of that; not by anything if it is no number. */
bool near_number(const char *what, double expected, double got, double share, char why[WHY_BYTES]);

/* Every particle of the start is somewhere: start = rock + deposit + fallen + left. */
bool balances(const struct ledger *ledger, char why[WHY_BYTES]);

/* What a small job's last frame is known by. */
struct measure {
    struct ledger ledger;
    double volume_m3;
    double lost_m3;       /* since the start */
    double height_m;      /* mean of the particles */
    double stress_p95_Pa; /* of |T|; 0 where the model has none */
};

/* Against a recorded one: the start is the same, the ledger balances, and numbers are as near as devices come (compare.c). */
bool same_measure(const struct measure *recorded, const struct measure *got, char why[WHY_BYTES]);

/* The 95th percentile of |value|; 0 of nothing. Reorders the values. */
double percentile_95(float *value, size_t n);

#endif
