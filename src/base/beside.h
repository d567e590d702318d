/* Programs and libraries of ours that are installed with this one: beside it, in ../libexec/hoodoo, or in the folder that
 * HOODOO_LIBEXEC names. */
#ifndef HOODOO_BESIDE_H
#define HOODOO_BESIDE_H

#include <stdbool.h>

enum { BESIDE_PATH = 4096 };

/* For a sentence, with the file's name as its argument. */
#define BESIDE_HINT                                                                                          \
    "%s stands neither beside hoodoo nor in ../libexec/hoodoo; install it there, or name its folder in "     \
    "HOODOO_LIBEXEC"

/* HOODOO_LIBEXEC alone, if it is set. False if there is no such file. */
bool beside_find(const char *name, char out[BESIDE_PATH]);

#endif
