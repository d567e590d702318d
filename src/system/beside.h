/* Finds helper programs and libraries of hoodoo: beside the program, in ../libexec/hoodoo, or in the folder given by
 * HOODOO_LIBEXEC. */
#ifndef HOODOO_BESIDE_H
#define HOODOO_BESIDE_H

#include <stdbool.h>

enum { BESIDE_PATH = 4096 };

/* Message for a file that was not found; the argument is its name. */
#define BESIDE_HINT                                                                                          \
    "%s is neither beside hoodoo nor in ../libexec/hoodoo; install it there, or set HOODOO_LIBEXEC to its folder"

/* Sets `out` to the path of this program, or of the launcher that started it; returns false if it is not known or too long. */
bool beside_self(char out[BESIDE_PATH]);

/* Sets `out` to the path of the file `name`; returns false if it is not found. If HOODOO_LIBEXEC is set, only that folder is
 * searched. */
bool beside_find(const char *name, char out[BESIDE_PATH]);

#endif
