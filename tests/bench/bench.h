/* What the benches share: ending on an error, and the rows of results that tests/bench/run.py reads. */
#ifndef HOODOO_BENCH_H
#define HOODOO_BENCH_H

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/status.h"

/* Ends the program with the error's message and exit code, if there is one. */
static inline void check(status st)
{
    if (st == OK)
        return;
    fprintf(stderr, "%s: %s\n", program_invocation_short_name, status_message());
    exit((int)st);
}

/* Zeroed memory for n items; ends the program where there is none. */
static inline void *need(size_t n, size_t size)
{
    void *memory = calloc(n, size);
    if (!memory)
        check(fail(E_MEMORY, "no memory for %zu items", n));
    return memory;
}

enum { BENCH_SAMPLES = 32, BENCH_REPEATS = 5 };

/* One measurement repeated n times. */
struct samples {
    size_t n;
    double at[BENCH_SAMPLES];
};

static inline void sample(struct samples *s, double value)
{
    if (s->n < BENCH_SAMPLES)
        s->at[s->n++] = value;
}

static inline struct samples once(double value)
{
    return (struct samples){1, {value}};
}

struct row {
    const char *name; /* "group: what is measured"; equal names are rows of one case with several peers */
    const char *unit; /* of the samples */
    struct samples ours, theirs;
    const char *peer; /* what `theirs` was measured on; NULL: nothing to compare with */
    double at_least;  /* the goal for the median of theirs / the median of ours; 0: none */
    double at_most;   /* the goal for the median of ours; 0: none */
};

static inline void row_samples(const char *key, const struct samples *s)
{
    printf(", \"%s\": [", key);
    for (size_t i = 0; i < s->n; i++)
        printf("%s%.9g", i ? ", " : "", s->at[i]);
    printf("]");
}

/* Prints the row as one line of JSON. Names hold nothing that JSON escapes. */
static inline void print_row(const struct row *r)
{
    printf("{\"case\": \"%s\", \"unit\": \"%s\"", r->name, r->unit);
    row_samples("ours", &r->ours);
    if (r->peer) {
        printf(", \"peer\": \"%s\"", r->peer);
        row_samples("theirs", &r->theirs);
    }
    if (r->at_least > 0)
        printf(", \"at_least\": %g", r->at_least);
    if (r->at_most > 0)
        printf(", \"at_most\": %g", r->at_most);
    printf("}\n");
    fflush(stdout);
}

#endif
