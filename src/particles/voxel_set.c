#include "particles/voxel_set.h"

#include <stdlib.h>

#include "base/memory.h"

status voxel_set_create(const int n[3], const char *what, struct voxel_set *out)
{
    status st = OK;
    *out = (struct voxel_set){.n = {n[0], n[1], n[2]}, .row_words = ((size_t)n[0] + 31) / 32};
    out->words = out->row_words * (size_t)n[1] * (size_t)n[2];
    TRY(memory_alloc(out->words, sizeof *out->bits, what, &out->bits));
    TRY(memory_alloc(out->words + 1, sizeof *out->before, what, &out->before));
done:
    if (st != OK)
        voxel_set_destroy(out);
    return st;
}

void voxel_set_destroy(struct voxel_set *s)
{
    free(s->bits);
    free(s->before);
    *s = (struct voxel_set){0};
}

status voxel_set_rank(struct voxel_set *s)
{
    uint64_t sum = 0;
    for (size_t w = 0; w < s->words; w++) {
        sum += (uint64_t)bits_in(s->bits[w]);
        if (sum > UINT32_MAX)
            return fail(E_MEMORY, "scene: it has more than 2^32 particles: raise domain.spacing_m");
        s->before[w + 1] = (uint32_t)sum;
    }
    return OK;
}
