/* The room between bedrock: what loose material moves through.
 *
 * A space is an interval of one stack between two layers of solid material, or above the last. What is loose
 * in it lies on its floor, merged by material and sorted in the table's order (Arches 3.4, figure 6); water
 * on top of it. Stacks are opened into spaces tile by tile, where they are first asked for.
 */
#ifndef HOODOO_SPACES_H
#define HOODOO_SPACES_H

#include <stdbool.h>

#include "stacks/stacks.h"

/* What is solid: air, and bedrock, never move. Loose materials in the order they lie in, water last. */
struct spaces_kinds {
    uint32_t solid; /* a bit each */
    int n;          /* loose materials, water among them */
    uint32_t material[MATERIALS_MAX];
    int slot[MATERIALS_MAX]; /* of a material in `material`; -1: air or solid */
};

/* From the table: a material is solid if its repose is 90 degrees or more. */
struct spaces_kinds spaces_kinds(const struct material *table, int n);

enum { SPACE_LOOSE = 12 };

struct space {
    uint32_t floor, ceiling; /* quanta; the top space's ceiling is STACK_TOP */
    uint32_t amount[SPACE_LOOSE];
};

struct space_tile {
    bool open, changed;
    uint32_t first[STACK_TILE * STACK_TILE + 1];
    struct space *space;
    uint8_t *mark; /* one a space, for whoever walks them */
};

struct spaces {
    const struct stacks *stacks;
    struct spaces_kinds kinds;
    struct space_tile *tile;
};

MUST_USE status spaces_create(const struct stacks *stacks, const struct spaces_kinds *kinds,
                              struct spaces *out);
void spaces_destroy(struct spaces *s);

/* Opens the tiles of the stacks lo..hi (inclusive, cut to the grid). */
MUST_USE status spaces_open(struct spaces *s, const int lo[2], const int hi[2]);

/* The spaces of an open stack. */
static inline struct space *spaces_at(const struct spaces *s, int i, int j, int *n)
{
    const struct space_tile *t =
        &s->tile[(size_t)(j / STACK_TILE) * (size_t)s->stacks->tiles[0] + (size_t)(i / STACK_TILE)];
    int slot = j % STACK_TILE * STACK_TILE + i % STACK_TILE;
    *n = (int)(t->first[slot + 1] - t->first[slot]);
    return t->space + t->first[slot];
}

/* The tile of a stack, opened when need be. */
MUST_USE status spaces_tile(struct spaces *s, int i, int j, struct space_tile **out);

/* Back into stacks (those they came from, or a copy): the open tiles, or with `all` false those marked as
 * changed. Solid layers stay; water that has no room under a ceiling is lost, and counted in *lost. */
MUST_USE status spaces_close(const struct spaces *s, bool all, struct stacks *out, uint64_t *lost);

#endif
