/* "Did you mean": the known word at the smallest edit distance. */
#ifndef HOODOO_NEAREST_H
#define HOODOO_NEAREST_H

#include <stddef.h>

/* The one of n known words that is nearest to `word`, or NULL if none is near enough to be what was meant. */
const char *nearest_word(const char *word, const char *const *known, size_t n);

#endif
