/* The stress at any places in the rock, many of which may be asked for one after another. */
#ifndef HOODOO_STRESS_PLACES_H
#define HOODOO_STRESS_PLACES_H

#include "stress/elastic.h"

/* Places that can be asked for together. */
enum { PLACES_MOST = 1 << 18 };

/* Nothing else may be done with the solver between begin and end. */
struct stress_places {
    struct elastic *e;
    struct particles at; /* with P, stress and von_mises alone */
    bool recovered;
};

/* The stress must be current. stress_places_end(), begun or not. */
MUST_USE status stress_places_begin(struct gpu *gpu, struct elastic *e, struct stress_places *out);
void stress_places_end(struct gpu *gpu, struct stress_places *s);

/* P (vec4, m) of n places to s->at's stress and von_mises. */
MUST_USE status stress_places_find(struct gpu *gpu, struct stress_places *s, const float *P, size_t n);

#endif
