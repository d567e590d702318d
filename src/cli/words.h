/* Answers: built once as JSON, printed as JSON for programs or as aligned words for people.
 *
 * In words   underscores become spaces; *_bytes become "4.2 MB" and *_seconds "2 min 6 s"; a list of alike
 * flat objects becomes a table. Control characters (texts may come from any file) become spaces.
 */
#ifndef HOODOO_WORDS_H
#define HOODOO_WORDS_H

#include <stdbool.h>

#include "base/text.h"

/* Prints the finished JSON in `answer` on stdout. */
MUST_USE status words_print(const struct text *answer, bool as_json);

#endif
