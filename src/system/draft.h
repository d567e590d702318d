/* A file while it is made: bytes are appended at its end, and earlier ones may be replaced.
 *
 * {0} is an empty draft in memory, whose bytes are in `bytes`. atomic_file_begin() makes one on disk, of which only the last bytes
 * are in memory, so that a file of any size takes little. Both hold the same bytes.
 *
 * Errors     E_MEMORY; E_OUTPUT for drafts on disk: the message has the file's path, its size so far and the system's reason.
 */
#ifndef HOODOO_DRAFT_H
#define HOODOO_DRAFT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/path.h"
#include "base/status.h"

struct draft {
    char *bytes;   /* in memory: the file; on disk: its last `held` bytes, not written yet */
    uint64_t size; /* of the file, bytes */
    size_t held, room;
    bool on_disk;
    int fd;
    struct path path, temporary; /* of the finished file, for messages; of the file that is written */
};

#ifdef __cplusplus
extern "C" {
#endif

MUST_USE status draft_append(struct draft *d, const void *bytes, size_t n);

/* Replaces n bytes from `at` on, all of which must exist. */
MUST_USE status draft_replace(struct draft *d, uint64_t at, const void *bytes, size_t n);

/* The hash (hash.h) of the bytes from `from` up to but not including `to`, which must exist. */
MUST_USE status draft_hash(struct draft *d, uint64_t from, uint64_t to, uint64_t *hash);

/* Writes all bytes of a draft on disk to its file. Nothing to do in memory. */
MUST_USE status draft_flush(struct draft *d);

/* Frees the memory and, on disk, removes the unfinished file. Harmless on {0}; leaves {0}. */
void draft_drop(struct draft *d);

#ifdef __cplusplus
}
#endif
#endif
