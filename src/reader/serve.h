/* The other side of reader.h: what a reader's main() calls, and how decoders answer.
 *
 * Limits    Set before the file is looked at: CPU time and memory by the file's size (limits.h), no core dump, /dev/null
 *           for what libraries say.
 * Calls     A list of the system calls that reading takes; every other one fails with EPERM. Files are opened for reading
 *           only; there are no sockets, no other programs or processes, and no memory becomes code.
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
    const char *const *word; /* NULL ends them */
    size_t n_words;
    uint64_t n_input; /* bytes that READER_INPUT_FD holds */
};

/* The answer under way. */
struct serve_answer {
    struct reader_head head;
};

/* Begins a part; what is added goes to the last one. E_MEMORY: there is no room for it. */
MUST_USE status serve_part(struct serve_answer *answer);
MUST_USE status serve_add(struct serve_answer *answer, const void *bytes, size_t n);

/* A part of its own. */
MUST_USE status serve_put(struct serve_answer *answer, const void *bytes, size_t n);

/* n bytes of the input from `at` on. E_INPUT: it has fewer. */
MUST_USE status serve_input(const struct serve_question *question, void *to, size_t n, uint64_t at);

struct serve_kind {
    const char *name;
    uint64_t memory; /* bytes that even a small file may take */
    status (*read)(const struct serve_question *question, struct serve_answer *answer);
};

/* The limits alone, for a file of `size` bytes: `base` bytes of memory and more. */
void serve_limits(uint64_t base, uint64_t size);

/* Answers the question in argv and returns the exit code: 0, or 2 if there is none. */
int serve(int argc, char **argv, const struct serve_kind *kind, size_t n_kinds);

#ifdef __cplusplus
}
#endif
#endif
