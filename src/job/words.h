/* Type, default and range of a key as text, for the reference page, the terminal and messages. */
#ifndef HOODOO_JOB_WORDS_H
#define HOODOO_JOB_WORDS_H

#include "job/table.h"
#include "text/text.h"

/* "number", "list of points". */
const char *key_type_words(const struct job_key *key);

/* Adds the default as written in a job; nothing for keys without a default, such as nested sections. Not for required keys. */
void key_default_words(const struct job_key *key, struct text *out);

/* "0 .. 1000", or the choices; "" if the value is not restricted. Returns out. */
const char *key_range_words(const struct job_key *key, char out[256]);

#endif
