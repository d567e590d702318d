/* The self-contained jobs of the folder jobs/, embedded in the program. */
#ifndef HOODOO_EXAMPLES_H
#define HOODOO_EXAMPLES_H

#include <stddef.h>

struct job_example {
    const char *name;        /* "demo" */
    const char *const *line; /* lines including their newlines, ended by NULL */
};

/* Sorted by name; an entry with name NULL ends the list. */
extern const struct job_example job_examples[];

#endif
