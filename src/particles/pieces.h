/* A frame's rock a piece at a time, so that the particles of all of it are never in memory at once: those that there are, and those
 * that are made of rock that has none (struct frame_deep).
 *
 * A piece is a layer of the domain's voxels with about PIECE_MOST particles, in voxel order, whichever of them are made. Rock that
 * is not in the order of voxels is cut by number.
 */
#ifndef HOODOO_PIECES_H
#define HOODOO_PIECES_H

#include "particles/frame.h"

enum { PIECE_MOST = 1 << 21 };

struct rock_pieces {
    const struct rock *rock;
    const struct frame_deep *deep;
    size_t n; /* at least 1 */
    /* [n + 1] of each piece and the end: the first of the rock's particles, of the words of deep voxels, of their values */
    struct piece_start {
        size_t rock, word, deep;
    } * start;
};

/* Both outlive it. `deep`: NULL where there is none. rock_pieces_end(). */
MUST_USE status rock_pieces_begin(const struct rock *rock, const struct frame_deep *deep,
                                  struct rock_pieces *out);
void rock_pieces_end(struct rock_pieces *pieces);

/* Piece i, with the fields that the rock has; freed with rock_piece_free(), as it may be the rock itself. */
MUST_USE status rock_piece(const struct rock_pieces *pieces, size_t i, struct rock *out);
void rock_piece_free(const struct rock_pieces *pieces, struct rock *piece);

#endif
