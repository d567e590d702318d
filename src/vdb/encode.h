/* OpenVDB files as bytes: what vdb.h's vdb_volumes() and vdb_points() call in hoodoo-vdb.so. */
#ifndef HOODOO_VDB_ENCODE_H
#define HOODOO_VDB_ENCODE_H

#include "vdb/vdb.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef status vdb_encode_volumes_function(const struct frame_grids *grids, const struct vdb_options *options,
                                           struct vdb_bytes *out);
/* A frame's rock, piece by piece (particles/pieces.h). Where get() fails the file is not made, and get() has said why. */
struct vdb_pieces {
    const struct rock *rock;
    size_t n;
    void *user;
    status (*get)(void *user, size_t i, struct rock *out);
    void (*drop)(void *user, struct rock *piece);
};
typedef status vdb_encode_points_function(const struct vdb_pieces *pieces, const struct vdb_options *options,
                                          struct vdb_bytes *out);

vdb_encode_volumes_function vdb_encode_volumes;
vdb_encode_points_function vdb_encode_points;

#ifdef __cplusplus
}
#endif
#endif
