/* Encoding a checkpoint. Chunks are packed in parallel, each into a slot of its own, and then moved together, so the bytes do not
 * depend on the number of threads. */
#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/memory.h"
#include "checkpoint/chunk.h"
#include "checkpoint/layout.h"

const char head_magic[12] = "hoodoo.ckpt";
const char end_magic[8] = {'c', 'k', 'p', 't', '.', 'e', 'n', 'd'};

static void check(const struct checkpoint *c)
{
    assert(c->n_sections <= CHECKPOINT_SECTIONS_MAX);
    for (size_t i = 0; i < c->n_sections; i++) {
        const struct checkpoint_section *s = &c->section[i];
        assert(s->item > 0 && s->item <= CHUNK_ITEM_MAX && s->n <= SIZE_MAX / 2 / s->item && *s->name);
        for (size_t k = 0; k < i; k++)
            assert(strcmp(s->name, c->section[k].name) != 0);
    }
}

/* Packs the chunks of one section into slots of `stride` bytes each. */
static status pack_section(const struct checkpoint_section *s, struct chunk *chunk, unsigned char *slots,
                           size_t stride)
{
    bool out_of_memory = false;
    size_t n = section_chunks(s), raw = chunk_raw_size(s->item);
    if (n == 0)
        return OK;
#pragma omp parallel if (n > 1) reduction(|| : out_of_memory)
    {
        void *scratch = malloc(section_chunk_raw(s, 0));
        /* Set even if this thread would get no chunk, so that the result does not depend on the scheduling. */
        out_of_memory = !scratch;
#pragma omp for schedule(dynamic)
        for (size_t k = 0; k < n; k++) {
            const unsigned char *from = (const unsigned char *)s->data + k * raw;
            chunk[k].size =
                scratch ? chunk_pack(from, section_chunk_raw(s, k), s->item, scratch, slots + k * stride) : 0;
            out_of_memory = out_of_memory || chunk[k].size == 0;
        }
        free(scratch);
    }
    return out_of_memory ? fail(E_MEMORY, "out of memory: packing '%s' for a checkpoint", s->name) : OK;
}

/* Moves the content of the slots together, beginning at `at`; returns the offset behind it. */
static size_t gather(unsigned char *file, size_t at, size_t slots, size_t stride, struct chunk *chunk,
                     size_t n)
{
    for (size_t k = 0; k < n; k++) {
        memmove(file + at, file + slots + k * stride, chunk[k].size);
        chunk[k].at = at;
        at += chunk[k].size;
    }
    return at;
}

static size_t section_bound(const struct checkpoint_section *s)
{
    return section_chunks(s) * chunk_bound(chunk_raw_size(s->item));
}

/* Writes head and sections to `file`; *size is then the offset of the index. */
static status pack_sections(const struct checkpoint *c, struct layout *layout, unsigned char *file,
                            size_t *size)
{
    struct file_head head = {.format = CHECKPOINT_FORMAT};
    memcpy(head.magic, head_magic, sizeof head.magic);
    memcpy(file, &head, sizeof head);
    size_t at = sizeof head;
    for (size_t i = 0; i < c->n_sections; i++) {
        const struct checkpoint_section *s = &c->section[i];
        struct chunk *chunk = layout->chunk + layout->first[i];
        size_t n = section_chunks(s), stride = chunk_bound(chunk_raw_size(s->item));
        /* The slots begin at `at`, and a chunk is never larger than its slot, so gather() only moves bytes down. */
        status st = pack_section(s, chunk, file + at, stride);
        if (st != OK)
            return st;
        at = gather(file, at, at, stride, chunk, n);
        layout->hash[i] = hash_bytes(s->data, s->n * s->item);
    }
    *size = at;
    return OK;
}

status checkpoint_encode(const struct checkpoint *c, void *bytes, size_t *size)
{
    status st = OK;
    struct layout layout = {0};
    struct text index = {0};
    unsigned char *file = NULL;
    /* An upper bound for the slots of all sections. Pages that are never written take no memory. */
    size_t bound = sizeof(struct file_head) + sizeof(struct file_end);
    check(c);
    if (!isfinite(c->years))
        return fail(E_NUMERIC, "frame %d: its number of years is not finite; no checkpoint is written",
                    c->frame);
    for (size_t i = 0; i < c->n_sections; i++) {
        layout.first[i + 1] = layout.first[i] + section_chunks(&c->section[i]);
        bound += section_bound(&c->section[i]);
    }
    layout.n_chunks = layout.first[c->n_sections];
    TRY(memory_alloc(layout.n_chunks, sizeof *layout.chunk, "the chunk table", &layout.chunk));
    TRY(memory_alloc(bound, 1, "a checkpoint", &file));

    size_t at = 0;
    TRY(pack_sections(c, &layout, file, &at));
    TRY(index_write(c, &layout, &index));
    if (index.size > INDEX_SIZE_MAX) {
        st = fail(E_MEMORY, "frame %d: the state has %zu chunks, more than a checkpoint can hold", c->frame,
                  layout.n_chunks);
        goto done;
    }
    struct file_end end = {.index_at = at, .index_size = index.size};
    unsigned char *whole = realloc(file, at + index.size + sizeof end);
    if (!whole) {
        st = fail(E_MEMORY, "out of memory: a checkpoint needs %zu bytes", at + index.size + sizeof end);
        goto done;
    }
    file = whole;
    memcpy(file + at, index.data, index.size);
    at += index.size;
    end.hash = hash_bytes(file, at);
    memcpy(end.magic, end_magic, sizeof end.magic);
    memcpy(file + at, &end, sizeof end);
    *size = at + sizeof end;
    memcpy(bytes, &file, sizeof file);
    file = NULL;
done:
    free(file);
    free(layout.chunk);
    text_free(&index);
    return st;
}
