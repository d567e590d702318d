#include "base/idset.h"

#include <stdlib.h>

#include "base/memory.h"

enum { LEAVES = 1 << 16, WORDS = (1 << 16) / 64 };

void idset_free(struct idset *s)
{
    for (size_t i = 0; s->leaf && i < LEAVES; i++)
        free(s->leaf[i]);
    free(s->leaf);
    *s = (struct idset){0};
}

status idset_add(struct idset *s, uint32_t id, bool *added)
{
    status st = OK;
    if (!s->leaf)
        TRY(memory_alloc(LEAVES, sizeof *s->leaf, "a set of ids", &s->leaf));
    uint64_t **leaf = &s->leaf[id >> 16];
    if (!*leaf)
        TRY(memory_alloc(WORDS, sizeof **leaf, "a set of ids", leaf));
    uint64_t *word = &(*leaf)[(id & 0xffff) / 64], bit = UINT64_C(1) << id % 64;
    *added = (*word & bit) == 0;
    *word |= bit;
done:
    return st;
}

bool idset_remove(struct idset *s, uint32_t id)
{
    uint64_t *leaf = s->leaf ? s->leaf[id >> 16] : NULL, bit = UINT64_C(1) << id % 64;
    if (!leaf || !(leaf[(id & 0xffff) / 64] & bit))
        return false;
    leaf[(id & 0xffff) / 64] &= ~bit;
    return true;
}
