/* The reader's side of reader.h: what the main() of a reader calls, and how decoders write their answers.
 *
 * Limits    Set before the file is opened: CPU time and memory depending on the file's size (limits.h), no core dump. Messages of
 *           libraries go to /dev/null.
 * Calls     Only the system calls that reading needs are allowed; all others fail with EPERM. Files can only be opened for reading;
 *           there are no sockets, no other programs or processes, and no executable memory.
 */
#ifndef HOODOO_SERVE_H
#define HOODOO_SERVE_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "reader/protocol.h"

#ifdef __cplusplus
extern "C" {
#endif

struct serve_question {
    const char *path;
    const char *const *argument; /* ended by NULL */
    size_t n_arguments;
    uint64_t n_input; /* bytes available on READER_INPUT_FD */
};

/* The answer being written. */
struct serve_answer {
    struct reader_head head;
};

/* Begins a new part, and appends to the last part. E_INPUT: too many parts. E_MEMORY: there is no memory for the answer. */
MUST_USE status serve_begin_part(struct serve_answer *answer);
MUST_USE status serve_append(struct serve_answer *answer, const void *bytes, size_t n);

/* Adds a whole part. */
MUST_USE status serve_add_part(struct serve_answer *answer, const void *bytes, size_t n);

/* Copies n bytes of the input, from offset `at`. E_INPUT: the input is shorter. */
MUST_USE status serve_input(const struct serve_question *question, void *to, size_t n, uint64_t at);

struct serve_kind {
    const char *name;
    uint64_t memory; /* bytes that even a small file may need */
    status (*read)(const struct serve_question *question, struct serve_answer *answer);
};

/* Sets the limits alone, for a file of `size` bytes: `base` bytes of memory plus a multiple of its size. */
void serve_limits(uint64_t base, uint64_t size);

/* Answers the request in argv. Returns the exit code of main(): 0, or 2 if argv is not a request. */
int serve(int argc, char **argv, const struct serve_kind *kind, size_t n_kinds);

#ifdef __cplusplus
}
#endif
#endif
