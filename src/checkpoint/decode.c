/* Reading a checkpoint: first its end, then the hash of the file, then the index, and last the sections. */
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <xxhash.h>

#include "base/hash.h"
#include "base/memory.h"
#include "checkpoint/chunk.h"
#include "checkpoint/layout.h"

status read_at(int fd, const char *path, uint64_t at, void *bytes, size_t n)
{
    for (size_t got = 0; got < n;) {
        ssize_t k = pread(fd, (char *)bytes + got, n - got, (off_t)(at + got));
        if (k < 0 && errno == EINTR)
            continue;
        if (k <= 0)
            return fail(E_CHECKPOINT, "%s: %s at byte %llu", path, k < 0 ? strerror(errno) : "the file ends",
                        (unsigned long long)(at + got));
        got += (size_t)k;
    }
    return OK;
}

/* ---- head, end and index */

static status read_ends(int fd, const char *path, uint64_t size, struct file_end *end)
{
    status st = OK;
    struct file_head head;
    if (size < sizeof head + sizeof *end)
        return fail(E_CHECKPOINT, "%s: not a checkpoint: only %llu bytes", path, (unsigned long long)size);
    TRY(read_at(fd, path, 0, &head, sizeof head));
    if (memcmp(head.magic, head_magic, sizeof head.magic) != 0)
        return fail(E_CHECKPOINT, "%s: not a checkpoint, or its first bytes are damaged", path);
    if (head.format != CHECKPOINT_FORMAT)
        return fail(E_CHECKPOINT, "%s: checkpoint format %u; this version of hoodoo reads format %d", path,
                    head.format, CHECKPOINT_FORMAT);
    TRY(read_at(fd, path, size - sizeof *end, end, sizeof *end));
    if (memcmp(end->magic, end_magic, sizeof end->magic) != 0)
        return fail(E_CHECKPOINT, "%s: truncated or overwritten: its %llu bytes do not end with the end mark",
                    path, (unsigned long long)size);
    uint64_t inside = size - sizeof *end;
    if (end->index_at < sizeof head || end->index_at > inside || end->index_size != inside - end->index_at ||
        end->index_size > INDEX_SIZE_MAX)
        return fail(
            E_CHECKPOINT,
            "%s: damaged: its end says that the index is at byte %llu and has %llu bytes, in a file of %llu bytes",
            path, (unsigned long long)end->index_at, (unsigned long long)end->index_size,
            (unsigned long long)size);
done:
    return st;
}

static status check_hash(int fd, const char *path, uint64_t size, uint64_t expected)
{
    enum { BLOCK = 1 << 20 };
    status st = OK;
    char *block = NULL;
    XXH3_state_t *hash = XXH3_createState();
    TRY(memory_alloc(BLOCK, 1, "a checkpoint's block", &block));
    if (!hash || XXH3_64bits_reset(hash) != XXH_OK) {
        st = fail(E_MEMORY, "%s: out of memory", path);
        goto done;
    }
    for (uint64_t at = 0; at < size;) {
        size_t n = size - at < BLOCK ? (size_t)(size - at) : BLOCK;
        TRY(read_at(fd, path, at, block, n));
        XXH3_64bits_update(hash, block, n);
        at += n;
    }
    if (XXH3_64bits_digest(hash) != expected)
        st = fail(E_CHECKPOINT, "%s: damaged: its content does not match its hash", path);
done:
    XXH3_freeState(hash);
    free(block);
    return st;
}

status layout_open(const char *path, struct checkpoint *c, struct layout *layout, int *fd)
{
    status st = OK;
    char *index = NULL;
    struct stat info;
    struct file_end end;
    *c = (struct checkpoint){0};
    *layout = (struct layout){0};
    /* Nonblocking, so that a pipe of that name does not hang the run. */
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0 || fstat(file, &info) != 0) {
        st = fail(E_CHECKPOINT, "%s: %s", path, strerror(errno));
        goto done;
    }
    if (!S_ISREG(info.st_mode)) {
        st = fail(E_CHECKPOINT, "%s: not a regular file", path);
        goto done;
    }
    TRY(read_ends(file, path, (uint64_t)info.st_size, &end));
    TRY(check_hash(file, path, end.index_at + end.index_size, end.hash));
    TRY(memory_alloc((size_t)end.index_size, 1, "a checkpoint's index", &index));
    TRY(read_at(file, path, end.index_at, index, (size_t)end.index_size));
    st = index_read(index, (size_t)end.index_size, end.index_at, c, layout);
    if (st == E_CHECKPOINT)
        fail(st, "%s: damaged index: %s", path, status_message());
done:
    free(index);
    if (file >= 0 && (st != OK || !fd))
        close(file);
    else if (fd)
        *fd = file;
    if (st != OK) {
        free(layout->chunk);
        *layout = (struct layout){0};
        *c = (struct checkpoint){0};
    }
    return st;
}

/* ---- sections */

static status read_section(int fd, const char *path, const struct layout *layout, size_t i,
                           struct checkpoint_section *s)
{
    status st = OK;
    size_t raw = chunk_raw_size(s->item), n = section_chunks(s), largest = n ? section_chunk_raw(s, 0) : 0;
    void *packed = NULL, *scratch = NULL;
    TRY(memory_alloc(s->n, s->item, s->name, &s->data));
    TRY(memory_alloc(chunk_bound(largest), 1, "a packed chunk", &packed));
    TRY(memory_alloc(largest, 1, "a chunk", &scratch));
    for (size_t k = 0; k < n; k++) {
        const struct chunk *chunk = &layout->chunk[layout->first[i] + k];
        TRY(read_at(fd, path, chunk->at, packed, (size_t)chunk->size));
        if (!chunk_unpack(packed, (size_t)chunk->size, s->item, scratch, (char *)s->data + k * raw,
                          section_chunk_raw(s, k))) {
            st = fail(E_CHECKPOINT, "%s: section '%s': chunk %zu of %zu (byte %llu) cannot be unpacked", path,
                      s->name, k + 1, n, (unsigned long long)chunk->at);
            goto done;
        }
    }
    if (hash_bytes(s->data, s->n * s->item) != layout->hash[i])
        st = fail(E_CHECKPOINT, "%s: damaged: section '%s' does not match its hash", path, s->name);
done:
    free(packed);
    free(scratch);
    return st;
}

status checkpoint_read(const char *path, struct checkpoint *c)
{
    status st = OK;
    struct layout layout;
    int fd = -1;
    size_t need = 0, have = memory_available() / 4 * 3; /* the rest is for the run */
    TRY(layout_open(path, c, &layout, &fd));
    /* A small file may claim to unpack to thirty thousand times its size, so check that it fits before allocating. */
    for (size_t i = 0; i < c->n_sections && need <= have; i++)
        need += c->section[i].n * c->section[i].item;
    if (need > have) {
        st = fail(E_MEMORY, "%s: the state needs more than the %zu MB of memory that are available for it",
                  path, have / 1000000);
        goto done;
    }
    for (size_t i = 0; i < c->n_sections; i++)
        TRY(read_section(fd, path, &layout, i, &c->section[i]));
done:
    if (fd >= 0) {
        close(fd);
        free(layout.chunk);
    }
    if (st != OK)
        checkpoint_free(c);
    return st;
}

status checkpoint_read_index(const char *path, struct checkpoint *c)
{
    struct layout layout;
    status st = layout_open(path, c, &layout, NULL);
    free(layout.chunk);
    return st;
}

void checkpoint_free(struct checkpoint *c)
{
    for (size_t i = 0; i < c->n_sections; i++)
        free(c->section[i].data);
    *c = (struct checkpoint){0};
}

const struct checkpoint_section *checkpoint_find(const struct checkpoint *c, const char *name, size_t item)
{
    for (size_t i = 0; i < c->n_sections; i++)
        if (c->section[i].item == item && strcmp(c->section[i].name, name) == 0)
            return &c->section[i];
    return NULL;
}
