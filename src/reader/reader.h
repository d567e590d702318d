/* Files that may be hostile, decoded in a program of their own: hoodoo-read (OpenVDB, OpenEXR) and hoodoo-read-image
 * (OpenImageIO).
 *
 * A reader is executed, so that it holds nothing of ours, and may use little of the system: limits on memory and time
 * that grow with the file, no core dump, neither stdout nor stderr, and only the system calls that reading takes (serve.h).
 * Whatever happens to it stays there.
 *
 * Calling sequence   reader_ask(); reader_take() of its parts, from the first to the last; reader_end().
 * Threads            Any number of readers at a time.
 */
#ifndef HOODOO_READER_H
#define HOODOO_READER_H

#include <stddef.h>

#include "base/status.h"
#include "base/text.h"
#include "reader/protocol.h"

struct reader_question {
    const char *program, *kind, *path;
    const char *const *word; /* more words of the question; NULL ends them. NULL: none */
    const void *input;       /* what it gets to read beside the file */
    size_t n_input;          /* bytes; 0: none */
    double seconds;          /* it is given; 0: by the file's size */
};

struct reader_answer {
    const char *path;
    int fd;
    size_t next; /* part */
    uint64_t at; /* where that begins */
    struct reader_head head;
};

/* Asks and waits. E_INPUT names the file: missing, damaged, or its reader crashed or ran into a limit. The same of a
 * reader that is not installed. E_MEMORY: no process or memory for it. */
MUST_USE status reader_ask(const struct reader_question *question, struct reader_answer *out);

/* The bytes of the next part; 0 if there is none. */
size_t reader_size(const struct reader_answer *answer);

/* The next part, which has to have `size` bytes, goes to `to`. E_INPUT if it has not. */
MUST_USE status reader_take(struct reader_answer *answer, void *to, size_t size);

/* The next part, `n` items of `size` bytes, in *out (freed with free()). E_INPUT if it is of another size. */
MUST_USE status reader_take_array(struct reader_answer *answer, size_t n, size_t size, void *out);

/* The next part as text, added to `out`. It is UTF-8: what is none in it became '?'. */
MUST_USE status reader_take_text(struct reader_answer *answer, struct text *out);

/* E_INPUT: what a reader says makes no sense. */
status reader_nonsense(const struct reader_answer *answer);

/* Harmless on {0} and twice. */
void reader_end(struct reader_answer *answer);

#endif
