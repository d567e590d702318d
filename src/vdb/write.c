#include "particles/pieces.h"
#include "system/library.h"
#include "vdb/encode.h"
#include "vdb/vdb.h"

/* Reading samples on behalf of the library, whose message is not this program's. */
struct reading {
    const struct grid_source *source;
    status st;
};

static status read_samples(void *user, const struct frame_grid *grid, float **out)
{
    struct reading *r = user;
    return r->st = r->source->read(r->source->user, grid, out);
}

status vdb_volumes(const struct frame_grids *grids, const struct vdb_options *options, struct draft *out)
{
    status st = OK;
    vdb_encode_volumes_function *encode = NULL;
    struct reading r = {&grids->source, OK};
    struct frame_grids own = *grids;
    own.source = (struct grid_source){&r, read_samples};
    TRY(library_find("vdb_encode_volumes", &encode));
    st = encode(&own, options, out);
    if (r.st == OK) /* otherwise the message is set already */
        st = library_status(st);
done:
    return st;
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
                           const struct vdb_options *options, struct draft *out)
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

status vdb_points(const struct rock *rock, const struct vdb_options *options, struct draft *out)
{
    return vdb_points_of_frame(rock, NULL, options, out);
}
