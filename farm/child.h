/* Child processes of the farm: hoodoo itself, sbatch, squeue. Never through a shell. */
#ifndef HOODOO_FARM_CHILD_H
#define HOODOO_FARM_CHILD_H

#include <sys/types.h>

#include "base/text.h"

struct child_variable {
    const char *name, *value; /* name NULL: none. What the user has set stays */
};

/* Starts argv[0], found along PATH, with stdin empty, stdout and stderr appended to `log`, signals at their
 * defaults and in a group of its own (a terminal's Ctrl-C reaches us alone). It gets SIGTERM when we die. */
MUST_USE status child_start(const char *const *argv, const char *log, const struct child_variable *variable,
                            size_t n_variables, pid_t *pid);

/* Why a child failed, for people: how it ended, and the last line of `log` that hoodoo said. */
void child_reason(int how, const char *log, char *out, size_t size);

/* Runs argv to its end: what it said on stdout in `out`, on stderr in `said` (the last 500 bytes), its exit
 * code in *code (127: there is no such program). */
MUST_USE status child_ask(const char *const *argv, struct text *out, char said[512], int *code);

#endif
