/* Encoding of OpenVDB files in memory: the functions of hoodoo-vdb.so that vdb_volumes() and vdb_points() call. */
#ifndef HOODOO_VDB_ENCODE_H
#define HOODOO_VDB_ENCODE_H

#include "vdb/vdb.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef status vdb_encode_volumes_function(const struct frame_grids *grids, const struct vdb_options *options,
                                           struct draft *out);
/* A frame's rock, piece by piece (particles/pieces.h). If get() fails, no file is made; get() has set the error message. */
struct vdb_pieces {
    const struct rock *rock;
    size_t n;
    void *user;
    status (*get)(void *user, size_t i, struct rock *out);
    void (*drop)(void *user, struct rock *piece);
};
typedef status vdb_encode_points_function(const struct vdb_pieces *pieces, const struct vdb_options *options,
                                          struct draft *out);

vdb_encode_volumes_function vdb_encode_volumes;
vdb_encode_points_function vdb_encode_points;

#ifdef __cplusplus
}
#endif
#endif
