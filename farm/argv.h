/* The arguments of a command that is run for the farm: sbatch, scancel, squeue. */
#ifndef HOODOO_FARM_ARGV_H
#define HOODOO_FARM_ARGV_H

#include "base/status.h"
#include "text/text.h"

/* {0} is empty; argv_free(). */
struct argv_list {
    char **argv; /* ends with NULL */
    size_t n, capacity;
    bool failed;
};

/* Adds a copy of the formatted text. After a failure to allocate, later calls do nothing. */
void argv_add(struct argv_list *a, const char *format, ...) PRINTF_LIKE(2, 3);

/* OK; E_MEMORY; or E_USAGE: one of them is longer than the kernel takes (128 KiB). */
MUST_USE status argv_status(const struct argv_list *a);
void argv_free(struct argv_list *a);

#endif
