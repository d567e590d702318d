/* Decoding of files that may be hostile, in helper programs: hoodoo-read (OpenVDB, OpenEXR), hoodoo-read-image (OpenImageIO) and
 * hoodoo-read-mesh (OBJ, PLY, STL, OFF, and glTF by Assimp).
 *
 * A reader is a child process of its own program, so it shares no memory with hoodoo, and is restricted: limits on memory and CPU time
 * that grow with the file, no core dump, no stdout or stderr, and only the system calls that reading needs (serve.h). If it crashes or
 * is killed, the caller gets an error.
 *
 * Calling sequence   reader_ask(); reader_take() for each part of the answer, in order; reader_end().
 * Threads            Any number of readers may run at the same time.
 */
#ifndef HOODOO_READER_H
#define HOODOO_READER_H

#include <stddef.h>

#include "base/status.h"
#include "reader/protocol.h"
#include "text/text.h"

struct reader_question {
    const char *program, *kind, *path;
    const char *const *argument; /* further arguments, ended by NULL; or NULL */
    const void *input;           /* data passed to the reader besides the file */
    size_t n_input;              /* bytes; 0: none */
    double seconds;              /* time limit; 0: one that depends on the size of the file */
};

struct reader_answer {
    const char *path;
    int fd;
    size_t next; /* the next part */
    uint64_t at; /* its offset */
    struct reader_head head;
};

/* Starts the reader and waits for its answer. E_INPUT, with the file's name: the file is missing or damaged, the reader crashed or
 * exceeded a limit, or the reader is not installed. E_MEMORY: there is no memory for the child process or its answer. */
MUST_USE status reader_ask(const struct reader_question *question, struct reader_answer *out);

/* Takes an answer that is in the file fd, and ownership of fd, for tests: as reader_ask() does after the reader has exited. E_INPUT: it is
 * malformed, or the reader's error. */
MUST_USE status reader_adopt(const char *path, int fd, struct reader_answer *out);

/* Bytes of the next part; 0 if there is none. */
size_t reader_size(const struct reader_answer *answer);

/* Copies the next part to `to`. E_INPUT if it does not have `size` bytes. */
MUST_USE status reader_take(struct reader_answer *answer, void *to, size_t size);

/* Allocates *out for the next part, `n` items of `size` bytes; freed with free(). E_INPUT if the part has another size. */
MUST_USE status reader_take_array(struct reader_answer *answer, size_t n, size_t size, void *out);

/* Adds the next part, a text, to `out`. Bytes that are not valid UTF-8 are replaced by '?'. */
MUST_USE status reader_take_text(struct reader_answer *answer, struct text *out);

/* Returns E_INPUT: the answer is malformed. */
status reader_bad_answer(const struct reader_answer *answer);

/* Frees the answer. May be called twice, and on {0}. */
void reader_end(struct reader_answer *answer);

#endif
