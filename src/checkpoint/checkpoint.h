/* Checkpoints: a flat, versioned container that says when it is damaged.
 *
 * Layout (little endian)
 *   magic "hoodoo.ckpt\0", format version
 *   sections: each a run of chunks of at most 4 MiB raw; a chunk is byte-shuffled by the item size and
 *             compressed by zstd
 *   index: JSON: provenance, and each section's name, item size, count, XXH3 of the raw bytes, and its chunks
 *             (offset, size)
 *   end: offset and size of the index, XXH3 of everything before the end, magic
 * The end is read first, so a torn file is refused before anything in it is believed. Every size is checked
 * against the file's.
 *
 * checkpoint/NAME.1010.ckpt is the state after frame 1010 was simulated: a run that continues begins with
 * frame 1011.
 */
#ifndef HOODOO_CHECKPOINT_H
#define HOODOO_CHECKPOINT_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "base/text.h"

enum { CHECKPOINT_SECTIONS_MAX = 64 };

struct checkpoint_section {
    char name[48];
    size_t item; /* bytes: the shuffle's stride */
    size_t n;    /* items */
    void *data;  /* n * item bytes */
};

/* What made a state. */
struct maker {
    char version[32], commit[32];  /* of hoodoo */
    char build[17];                /* hoodoo_build; "" in checkpoints of version 0.1.0, which had none */
    char device[256], driver[256]; /* as gpu_info() gives them */
};

struct checkpoint {
    int frame;
    double years;
    uint64_t job_hash;
    struct maker maker;
    size_t n_sections;
    struct checkpoint_section section[CHECKPOINT_SECTIONS_MAX];
};

/* The whole file in memory: freed with free(*bytes). Sections' data is only read. */
MUST_USE status checkpoint_encode(const struct checkpoint *c, void *bytes, size_t *size);

/* E_CHECKPOINT with what is wrong and where: truncated, flipped, of another format, hostile. On success the
 * sections' data are owned by *c: checkpoint_free(). */
MUST_USE status checkpoint_read(const char *path, struct checkpoint *c);

/* Everything but the sections' data, after checking the file hash. */
MUST_USE status checkpoint_read_index(const char *path, struct checkpoint *c);
void checkpoint_free(struct checkpoint *c);

/* NULL if there is none of that name and item size. */
const struct checkpoint_section *checkpoint_find(const struct checkpoint *c, const char *name, size_t item);

/* In words for `inspect`, as a JSON object's members. */
MUST_USE status checkpoint_describe(const char *path, struct text *out);

/* Writes root/checkpoint/NAME.FRAME.ckpt, then removes all but the newest `keep` (those beside a
 * NAME.FRAME.keep file stay). */
MUST_USE status checkpoint_save(const char *root, const char *name, const struct checkpoint *c, int keep);

/* Has the checkpoint of a frame kept, whether it is there yet or not: puts a NAME.FRAME.keep file beside it. */
MUST_USE status checkpoint_mark(const char *root, const char *name, int frame);

/* The checkpoint frames of `name`, newest first; freed with free(). */
MUST_USE status checkpoint_list(const char *root, const char *name, int **frames, size_t *n);

#endif
