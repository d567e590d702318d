/* Stress at arbitrary points in the rock, in batches of up to PLACES_MOST. */
#ifndef HOODOO_STRESS_PLACES_H
#define HOODOO_STRESS_PLACES_H

#include "stress/elastic.h"

/* The largest batch. */
enum { PLACES_MOST = 1 << 18 };

/* The solver must not be used otherwise between begin and end. */
struct stress_places {
    struct elastic *e;
    struct particles at; /* only the fields P, stress and von_mises exist */
    bool recovered;
};

/* The solution in *e must be current. Call stress_places_end() also if this fails. */
MUST_USE status stress_places_begin(struct gpu *gpu, struct elastic *e, struct stress_places *out);
void stress_places_end(struct gpu *gpu, struct stress_places *s);

/* Computes stress (T) and von_mises (Pa) at n points P (vec4 [n], m; n <= PLACES_MOST) into s->at's buffers. */
MUST_USE status stress_places_find(struct gpu *gpu, struct stress_places *s, const float *P, size_t n);

#endif
