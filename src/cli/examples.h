/* The jobs of jobs/ that need no other file, embedded. */
#ifndef HOODOO_EXAMPLES_H
#define HOODOO_EXAMPLES_H

#include <stddef.h>

struct job_example {
    const char *name;        /* "demo" */
    const char *const *line; /* each with its end, the last NULL */
};

/* By name; the last has none. */
extern const struct job_example job_examples[];

#endif
