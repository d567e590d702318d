/* Requests to readers whose answer is a text or nothing: "describe" and "check". */
#ifndef HOODOO_DESCRIBE_H
#define HOODOO_DESCRIBE_H

#include "reader/serve.h"
#include "text/text.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Asks hoodoo-read, and adds the text of its answer to the JSON being written in `out`. If `out` is NULL, only the status matters. */
MUST_USE status describe_ask(const char *kind, const char *path, struct text *out);

/* In the reader: begins a text that continues the caller's JSON, and ends it as the answer. */
void describe_begin(const struct serve_question *question, struct text *out);
MUST_USE status describe_end(struct text *text, struct serve_answer *answer);

#ifdef __cplusplus
}
#endif
#endif
