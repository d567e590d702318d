#include "particles/held.h"

#include <stdlib.h>

#include "base/memory.h"

/* Capacity of the list, which temporarily has a number per word while voxels are counted. */
static size_t room_for(const int voxels[3], size_t n)
{
    const size_t words = held_words(voxels) + 1;
    return n > words ? n : words;
}

uint64_t held_bytes(const int voxels[3], size_t n)
{
    return (uint64_t)held_words(voxels) * HELD_STRIDE * 4 + (uint64_t)room_for(voxels, n) * 4;
}

/* Replaces the list; its contents are lost. */
static status make_room(struct gpu *gpu, struct held_voxels *h, size_t n)
{
    status st = OK;
    gpu_buffer_destroy(gpu, &h->list);
    h->room = 0;
    TRY(gpu_buffer_create(gpu, "held voxels", room_for(h->voxels, n), 4, &h->list));
    h->room = room_for(h->voxels, n);
done:
    return st;
}

status held_create(struct gpu *gpu, const int voxels[3], size_t n, struct held_voxels *h)
{
    status st = OK;
    const size_t words = held_words(voxels);
    *h = (struct held_voxels){.voxels = {voxels[0], voxels[1], voxels[2]}};
    TRY(gpu_buffer_create(gpu, "voxels' slots", HELD_STRIDE * (words + 1), 4, &h->words));
    TRY(make_room(gpu, h, n));
done:
    if (st != OK)
        held_destroy(gpu, h);
    return st;
}

void held_destroy(struct gpu *gpu, struct held_voxels *h)
{
    gpu_buffer_destroy(gpu, &h->words);
    gpu_buffer_destroy(gpu, &h->list);
    *h = (struct held_voxels){0};
}

void held_vacate(struct gpu *gpu, struct held_voxels *h)
{
    const struct count_params k = {(uint)held_words(h->voxels)};
    GPU_RUN(gpu, particles_vacate, k.n, k, h->words);
}

status held_occupy(struct gpu *gpu, struct held_voxels *h, const uint32_t *bits)
{
    status st = OK;
    uint32_t *word = NULL;
    const size_t words = held_words(h->voxels);
    TRY(memory_alloc(HELD_STRIDE * words, sizeof *word, "voxels' bits", &word));
    for (size_t w = 0; w < words; w++)
        word[HELD_STRIDE * w + 2] = bits[w];
    TRY(gpu_upload(gpu, h->words, 0, word, HELD_STRIDE * words));
done:
    free(word);
    return st;
}

status held_find(struct gpu *gpu, struct gpu_work *work, struct held_voxels *h, bool around)
{
    status st = OK;
    const size_t words = held_words(h->voxels);
    const struct hold_params k = {.n = (uint)words + 1,
                                  .nx = (uint)h->voxels[0],
                                  .ny = (uint)h->voxels[1],
                                  .nz = (uint)h->voxels[2],
                                  .around = around};
    const struct count_params all = {(uint)words + 1};
    uint32_t n;
    GPU_RUN(gpu, particles_hold, k.n, k, h->words, h->list);
    gpu_scan(gpu, work, h->list, words + 1);
    GPU_RUN(gpu, particles_rank, all.n, all, h->list, h->words);
    TRY(gpu_download(gpu, h->list, words, &n, 1));
    if (n > h->room)
        TRY(make_room(gpu, h, n + n / 8));
    h->n = n;
    GPU_RUN(gpu, particles_list, all.n, all, h->words, h->list);
done:
    return st;
}

status held_all(struct gpu *gpu, struct gpu_work *work, struct held_voxels *h)
{
    status st = OK;
    uint32_t *bits = NULL;
    const size_t words = held_words(h->voxels), across = ((size_t)h->voxels[0] + 31) / 32;
    TRY(memory_alloc(words, sizeof *bits, "voxels' bits", &bits));
    for (size_t w = 0; w < words; w++) {
        const size_t left = (size_t)h->voxels[0] - 32 * (w % across);
        bits[w] = left < 32 ? (1U << left) - 1 : ~0U;
    }
    TRY(held_occupy(gpu, h, bits));
    TRY(held_find(gpu, work, h, false));
done:
    free(bits);
    return st;
}
