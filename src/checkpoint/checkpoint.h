/* Checkpoints: the state of a run in a versioned container that detects damage.
 *
 * Layout (little endian; FORMAT.md has every field)
 *   magic "hoodoo.ckpt\0", format version
 *   sections: each a sequence of chunks of at most 4 MiB, byte-shuffled by the item size and compressed with zstd
 *   index     JSON: provenance, and for each section its name, item size, count, XXH3 hash of the raw bytes, and the offset and
 *             size of its chunks
 *   end       offset and size of the index, XXH3 hash of everything before the end, magic
 * The end is read first, so that a truncated file is refused before its content is used. Every size is checked against the size of
 * the file.
 *
 * checkpoint/NAME.1010.ckpt is the state after frame 1010; a run that continues from it starts with frame 1011.
 */
#ifndef HOODOO_CHECKPOINT_H
#define HOODOO_CHECKPOINT_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "text/text.h"

enum { CHECKPOINT_SECTIONS_MAX = 64 };

struct checkpoint_section {
    char name[48];
    size_t item; /* bytes of an item, the stride of the shuffle */
    size_t n;    /* items */
    void *data;  /* n * item bytes */
};

/* The program and device that made a state. */
struct maker {
    char version[32], commit[32];  /* of hoodoo */
    char build[17];                /* hoodoo_build; "" in checkpoints of version 0.1.0, which had none */
    char device[256], driver[256]; /* as in gpu_info() */
};

struct checkpoint {
    int frame;
    double years;
    uint64_t job_hash;
    struct maker maker;
    size_t n_sections;
    struct checkpoint_section section[CHECKPOINT_SECTIONS_MAX];
};

/* Encodes the whole file in memory. `bytes` points to the pointer that receives it, freed with free(). The sections' data are only
 * read. */
MUST_USE status checkpoint_encode(const struct checkpoint *c, void *bytes, size_t *size);

/* E_CHECKPOINT, with what is wrong and where, if the file is truncated, damaged, of another format or hostile. On success *c owns the
 * sections' data; free with checkpoint_free(). */
MUST_USE status checkpoint_read(const char *path, struct checkpoint *c);

/* Checks the hash of the file and reads everything but the sections' data. */
MUST_USE status checkpoint_read_index(const char *path, struct checkpoint *c);
void checkpoint_free(struct checkpoint *c);

/* The section with that name and item size, or NULL. */
const struct checkpoint_section *checkpoint_find(const struct checkpoint *c, const char *name, size_t item);

/* Adds a description for `hoodoo inspect` to `out`, as the members of a JSON object. */
MUST_USE status checkpoint_describe(const char *path, struct text *out);

/* Writes root/checkpoint/NAME.FRAME.ckpt, then removes all but the newest `keep` checkpoints. Those with a NAME.FRAME.keep file beside
 * them are not removed. */
MUST_USE status checkpoint_save(const char *root, const char *name, const struct checkpoint *c, int keep);

/* Marks a frame's checkpoint to be kept, whether it exists yet or not, by writing NAME.FRAME.keep. */
MUST_USE status checkpoint_mark(const char *root, const char *name, int frame);

/* The frames of `name` that have a checkpoint, newest first; *frames is freed with free(). */
MUST_USE status checkpoint_list(const char *root, const char *name, int **frames, size_t *n);

#endif
