/* A set of voxels, stored as one bit per voxel: 32 voxels of a row along x per word; each row starts with a new word; rows in y, then
 * z order, which is also the order of the voxels' numbers (held_words() in held.h is the number of words). */
#ifndef HOODOO_VOXEL_SET_H
#define HOODOO_VOXEL_SET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

struct voxel_set {
    int n[3]; /* voxels of the domain */
    size_t row_words, words;
    uint32_t *bits; /* [words] */
    uint32_t
        *before; /* [words + 1]: the number of members in all words before; valid after voxel_set_rank() */
};

/* The empty set. Free with voxel_set_destroy(), which is harmless on {0}. E_MEMORY, with `what` it is for. */
MUST_USE status voxel_set_create(const int n[3], const char *what, struct voxel_set *out);
void voxel_set_destroy(struct voxel_set *s);

/* Numbers the members in voxel order; call it after the last change. E_MEMORY: there are more than 2^32. */
MUST_USE status voxel_set_rank(struct voxel_set *s);

static inline int bits_in(uint32_t word)
{
    return __builtin_popcount(word);
}

/* Runs a block for each set bit of a word, lowest first, with its number `bit`. */
#define EACH_BIT(word, ...)                                                                                  \
    for (uint32_t left = (word); left != 0; left &= left - 1) {                                              \
        const int bit = __builtin_ctz(left);                                                                 \
        __VA_ARGS__                                                                                          \
    }

static inline void voxel_set_at(const struct voxel_set *s, size_t word, int bit, int voxel[3])
{
    const size_t row = word / s->row_words, ny = (size_t)s->n[1];
    voxel[0] = (int)(32 * (word % s->row_words)) + bit;
    voxel[1] = (int)(row % ny);
    voxel[2] = (int)(row / ny);
}

static inline size_t voxel_set_word(const struct voxel_set *s, const int voxel[3])
{
    return ((size_t)voxel[2] * (size_t)s->n[1] + (size_t)voxel[1]) * s->row_words + (size_t)voxel[0] / 32;
}

static inline void voxel_set_add(struct voxel_set *s, const int voxel[3])
{
    s->bits[voxel_set_word(s, voxel)] |= 1U << (voxel[0] % 32);
}

static inline bool voxel_set_has(const struct voxel_set *s, const int voxel[3])
{
    return s->bits[voxel_set_word(s, voxel)] >> (voxel[0] % 32) & 1;
}

/* The number of members before bit `bit` of the word: the index of that voxel if it is a member. */
static inline uint32_t voxel_set_before(const struct voxel_set *s, size_t word, int bit)
{
    return s->before[word] + (uint32_t)bits_in(s->bits[word] & ((1U << bit) - 1));
}

/* The index of a member. */
static inline size_t voxel_set_index(const struct voxel_set *s, const int voxel[3])
{
    return voxel_set_before(s, voxel_set_word(s, voxel), voxel[0] % 32);
}

static inline size_t voxel_set_count(const struct voxel_set *s)
{
    return s->before[s->words];
}

#endif
