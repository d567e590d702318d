#include "stacks/file.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/memory.h"
#include "system/atomic_file.h"

static const char MAGIC[12] = "hoodoo.stck";
enum { VERSION = 1, MAX_BYTES = 1 << 30 };

struct header {
    char magic[12];
    uint32_t version;
    int32_t n[2];
    uint32_t solid, spare;
    uint64_t n_layers;
    double cell, quantum;
};
_Static_assert(sizeof(struct header) == 56, "the header has no padding");

status stacks_encode(const struct stacks *s, uint32_t solid, void **bytes, size_t *size)
{
    struct header header = {.version = VERSION,
                            .n = {s->n[0], s->n[1]},
                            .solid = solid,
                            .n_layers = stacks_layers(s),
                            .cell = s->cell,
                            .quantum = s->quantum};
    size_t columns = (size_t)s->n[0] * (size_t)s->n[1];
    char *file;
    uint64_t hash;
    memcpy(header.magic, MAGIC, sizeof MAGIC);
    *size = sizeof header + 4 * (columns + header.n_layers) + sizeof hash;
    status st = memory_alloc(*size, 1, "terrain", &file);
    if (st != OK)
        return st;
    memcpy(file, &header, sizeof header);
    uint32_t *count = (uint32_t *)(void *)(file + sizeof header);
    stacks_pack(s, count, count + columns);
    hash = hash_bytes(file, *size - sizeof hash);
    memcpy(file + *size - sizeof hash, &hash, sizeof hash);
    *bytes = file;
    return OK;
}

/* Is the header valid and consistent with a file of `size` bytes? */
static bool is_sane(const struct header *h, size_t size)
{
    if (memcmp(h->magic, MAGIC, sizeof MAGIC) != 0 || h->version != VERSION || h->n[0] < 1 || h->n[1] < 1)
        return false;
    if ((int64_t)h->n[0] * h->n[1] > STACKS_MAX || h->n_layers > MAX_BYTES / 4)
        return false;
    if (!(h->cell > 0 && h->cell < 1e6 && h->quantum > 0 && h->quantum < 1))
        return false;
    uint64_t words = (uint64_t)h->n[0] * (uint64_t)h->n[1] + h->n_layers;
    return size == sizeof *h + 4 * words + sizeof(uint64_t);
}

status stacks_read(const char *path, struct stacks *out, uint32_t *solid)
{
    status st = OK;
    void *bytes = NULL;
    size_t size = 0;
    struct header header;
    uint64_t hash;
    *out = (struct stacks){0};
    TRY(file_read(path, MAX_BYTES, &bytes, &size));
    if (size >= sizeof header + sizeof hash) {
        memcpy(&header, bytes, sizeof header);
        memcpy(&hash, (char *)bytes + size - sizeof hash, sizeof hash);
    }
    if (size < sizeof header + sizeof hash || !is_sane(&header, size) ||
        hash != hash_bytes(bytes, size - sizeof hash)) {
        st = fail(E_INPUT, "%s: not a .stacks file, or damaged", path);
        goto done;
    }
    const uint32_t *count = (const uint32_t *)(void *)((char *)bytes + sizeof header);
    TRY(stacks_create(header.n, header.cell, header.quantum * STACK_TOP, out));
    st = stacks_unpack(out, count, count + (size_t)header.n[0] * (size_t)header.n[1], header.n_layers);
    if (st == E_INPUT)
        st = fail(E_INPUT, "%s: damaged: its stacks are inconsistent", path);
    TRY(st);
    *solid = header.solid;
done:
    free(bytes);
    if (st != OK)
        stacks_destroy(out);
    return st;
}
