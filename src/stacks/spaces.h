/* The spaces between solid layers, through which loose material moves.
 *
 * A space is an interval of a stack between two solid layers, or above the last one. Its loose material rests on its floor, merged by
 * material and sorted in the table's order (Arches 3.4, figure 6), with water on top. Stacks are converted ("opened") into spaces tile
 * by tile, when they are first accessed.
 */
#ifndef HOODOO_SPACES_H
#define HOODOO_SPACES_H

#include <stdbool.h>

#include "stacks/stacks.h"

/* Solid materials, and loose ones in the order in which they are stacked, water last. */
struct spaces_kinds {
    uint32_t solid;                   /* set of materials, a bit each */
    int n;                            /* number of loose materials, including water */
    uint32_t material[MATERIALS_MAX]; /* by slot */
    int slot[MATERIALS_MAX];          /* by material; -1: air or solid */
};

/* From the table of n materials: solid if the angle of repose is 90 degrees or more. */
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
    uint8_t *mark; /* [spaces], for the algorithms that visit them: is it queued? */
};

struct spaces {
    const struct stacks *stacks;
    struct spaces_kinds kinds;
    struct space_tile *tile;
};

/* Opens no tile yet. `stacks` must outlive *out. E_MEMORY. */
MUST_USE status spaces_create(const struct stacks *stacks, const struct spaces_kinds *kinds,
                              struct spaces *out);
void spaces_destroy(struct spaces *s);

/* Opens the tiles of the stacks lo..hi (inclusive, clamped to the grid). E_MEMORY. */
MUST_USE status spaces_open(struct spaces *s, const int lo[2], const int hi[2]);

/* The *n spaces of a stack whose tile is open, bottom up. */
static inline struct space *spaces_at(const struct spaces *s, int i, int j, int *n)
{
    const struct space_tile *t =
        &s->tile[(size_t)(j / STACK_TILE) * (size_t)s->stacks->tiles[0] + (size_t)(i / STACK_TILE)];
    int slot = j % STACK_TILE * STACK_TILE + i % STACK_TILE;
    *n = (int)(t->first[slot + 1] - t->first[slot]);
    return t->space + t->first[slot];
}

/* The tile of a stack, which is opened if necessary. E_MEMORY. */
MUST_USE status spaces_tile(struct spaces *s, int i, int j, struct space_tile **out);

/* Writes spaces back into stacks (the original ones, or a copy): all open tiles, or with `all` false those marked as changed. Solid layers
 * remain. Water that does not fit below a ceiling is removed and counted in *lost, quanta; NULL: not counted. E_MEMORY. */
MUST_USE status spaces_close(const struct spaces *s, bool all, struct stacks *out, uint64_t *lost);

#endif
