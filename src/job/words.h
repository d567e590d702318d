/* What a key is, in words: for the reference page, the terminal and messages. */
#ifndef HOODOO_JOB_WORDS_H
#define HOODOO_JOB_WORDS_H

#include "base/text.h"
#include "job/table.h"

/* "number", "list of points". */
const char *key_type_words(const struct job_key *key);

/* Its default as it is written in a job; nothing for what has none, such as a list. Not of required keys. */
void key_default_words(const struct job_key *key, struct text *out);

/* "0 .. 1000", or the words it may be; "" where anything may stand. Returns out. */
const char *key_range_words(const struct job_key *key, char out[256]);

#endif
