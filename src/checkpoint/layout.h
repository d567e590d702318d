/* The fixed parts of a checkpoint file and its index, shared by the files of src/checkpoint/. checkpoint.h describes the layout. */
#ifndef HOODOO_CHECKPOINT_LAYOUT_H
#define HOODOO_CHECKPOINT_LAYOUT_H

#include "checkpoint/checkpoint.h"
#include "text/text.h"

#if __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "checkpoints are little endian; this code needs a little-endian machine"
#endif

enum {
    CHECKPOINT_FORMAT = 1,
    /* Enough for the chunks of 400 GB. Parsing takes a multiple of it in memory. */
    INDEX_SIZE_MAX = 4 << 20,
};

struct file_head {
    char magic[12];
    uint32_t format;
};

struct file_end {
    uint64_t index_at, index_size;
    uint64_t hash; /* of everything before the end */
    char magic[8];
};

_Static_assert(sizeof(struct file_head) == 16, "part of the format");
_Static_assert(sizeof(struct file_end) == 32, "part of the format");

extern const char head_magic[sizeof(((struct file_head *)0)->magic)];
extern const char end_magic[sizeof(((struct file_end *)0)->magic)];

struct chunk {
    uint64_t at, size; /* in the file */
};

/* What the index has beyond the members of struct checkpoint. */
struct layout {
    uint64_t hash[CHECKPOINT_SECTIONS_MAX];    /* of the raw bytes */
    size_t first[CHECKPOINT_SECTIONS_MAX + 1]; /* section i has the chunks first[i] .. first[i + 1] - 1 */
    struct chunk *chunk;                       /* owned */
    size_t n_chunks;
};

/* The number of chunks of a section, and the raw bytes of its k-th chunk. */
size_t section_chunks(const struct checkpoint_section *s);
size_t section_chunk_raw(const struct checkpoint_section *s, size_t k);

MUST_USE status index_write(const struct checkpoint *c, const struct layout *layout, struct text *out);

/* Parses the text of the index into *c (without data) and *layout, and checks every name, size and count, and that the chunks follow
 * each other without gaps from the head to `index_at`. E_CHECKPOINT; the message does not name the file. */
MUST_USE status index_read(const char *text, size_t size, uint64_t index_at, struct checkpoint *c,
                           struct layout *layout);

/* Reads everything of `path` but the sections: *c without data, and *layout, whose `chunk` the caller frees. If fd is not NULL, the
 * file stays open and *fd is its descriptor. */
MUST_USE status layout_open(const char *path, struct checkpoint *c, struct layout *layout, int *fd);

/* Reads n bytes at offset `at`. E_CHECKPOINT if the file is too short or cannot be read. */
MUST_USE status read_at(int fd, const char *path, uint64_t at, void *bytes, size_t n);

#endif
