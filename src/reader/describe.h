/* Questions to readers that are answered by a text, or by nothing but that all is well. */
#ifndef HOODOO_DESCRIBE_H
#define HOODOO_DESCRIBE_H

#include "base/text.h"
#include "reader/serve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Asks hoodoo-read, and adds what it says to the JSON under way in `out` (NULL: nothing is said). */
MUST_USE status describe_ask(const char *kind, const char *path, struct text *out);

/* In the reader: a text that goes on where the asker's stands, and its end. */
void describe_begin(const struct serve_question *question, struct text *out);
MUST_USE status describe_end(struct text *text, struct serve_answer *answer);

#ifdef __cplusplus
}
#endif
#endif
