/* Prints the answer of a verb, built as JSON, either as JSON or as aligned text for people.
 *
 * As text, underscores become spaces, *_bytes is printed like "4.2 MB" and *_seconds like "2 min 6 s", and a list of flat
 * objects with the same members becomes a table; `format` is left out. Control characters, which texts from any file may contain, become spaces.
 */
#ifndef HOODOO_ANSWER_H
#define HOODOO_ANSWER_H

#include <stdbool.h>

#include "text/text.h"

/* The version of the answers that JSON.md describes: it rises when a member changes its meaning or goes, not when one is added. */
enum { ANSWER_FORMAT = 1 };

/* Begins an answer: an object whose first member is `format`. */
void answer_begin(struct text *answer);

/* Prints the finished JSON in `answer` on stdout. */
MUST_USE status answer_print(const struct text *answer, bool as_json);

#endif
