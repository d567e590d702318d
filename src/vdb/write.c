#include "base/library.h"
#include "particles/pieces.h"
#include "vdb/encode.h"
#include "vdb/vdb.h"

status vdb_volumes(const struct frame_grids *grids, const struct vdb_options *options, struct vdb_bytes *out)
{
    vdb_encode_volumes_function *encode = NULL;
    status st = library_find("vdb_encode_volumes", &encode);
    return st == OK ? library_status(encode(grids, options, out)) : st;
}

/* The pieces, and the status of getting them. */
struct getting {
    struct rock_pieces pieces;
    status st;
};

static status get_piece(void *user, size_t i, struct rock *out)
{
    struct getting *g = user;
    return g->st = rock_piece(&g->pieces, i, out);
}

static void drop_piece(void *user, struct rock *piece)
{
    const struct getting *g = user;
    rock_piece_free(&g->pieces, piece);
}

status vdb_points_of_frame(const struct rock *rock, const struct frame_deep *deep,
                           const struct vdb_options *options, struct vdb_bytes *out)
{
    status st = OK;
    struct getting g = {{0}, OK};
    vdb_encode_points_function *encode = NULL;
    TRY(library_find("vdb_encode_points", &encode));
    TRY(rock_pieces_begin(rock, deep, &g.pieces));
    const struct vdb_pieces pieces = {rock, g.pieces.n, &g, get_piece, drop_piece};
    st = encode(&pieces, options, out);
    if (g.st == OK) /* otherwise the message is set already */
        st = library_status(st);
done:
    rock_pieces_end(&g.pieces);
    return st;
}

status vdb_points(const struct rock *rock, const struct vdb_options *options, struct vdb_bytes *out)
{
    return vdb_points_of_frame(rock, NULL, options, out);
}
