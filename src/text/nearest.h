/* Suggestions for misspelt names ("did you mean"), by edit distance. */
#ifndef HOODOO_NEAREST_H
#define HOODOO_NEAREST_H

#include <stddef.h>

/* The closest of the n known words, or NULL if none is close enough to be a plausible misspelling. A known word that `word` is a
 * prefix of counts as close. */
const char *nearest_word(const char *word, const char *const *known, size_t n);

#endif
