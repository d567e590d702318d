/* The rock of a frame, piece by piece, so that the particles of all of it are never in memory together: existing particles, and those that
 * are made of deep rock (struct frame_deep).
 *
 * A piece is a slab of the domain's voxels with about PIECE_MAX particles, in voxel order. Rock that is not sorted by voxel is cut by
 * particle number.
 */
#ifndef HOODOO_PIECES_H
#define HOODOO_PIECES_H

#include "particles/frame.h"

enum { PIECE_MAX = 1 << 21 };

struct rock_pieces {
    const struct rock *rock;
    const struct frame_deep *deep;
    size_t n; /* at least 1 */
    /* [n + 1]: each piece's first particle of the rock, word of deep voxels, and deep value; and their ends */
    struct piece_start {
        size_t rock, word, deep;
    } * start;
};

/* `rock` and `deep` (NULL: none) must outlive *out. Free with rock_pieces_end(). E_MEMORY. */
MUST_USE status rock_pieces_begin(const struct rock *rock, const struct frame_deep *deep,
                                  struct rock_pieces *out);
void rock_pieces_end(struct rock_pieces *pieces);

/* Makes piece i, with the fields that the rock has. Free with rock_piece_free() only, for it may be the rock itself. E_MEMORY. */
MUST_USE status rock_piece(const struct rock_pieces *pieces, size_t i, struct rock *out);
void rock_piece_free(const struct rock_pieces *pieces, struct rock *piece);

#endif
