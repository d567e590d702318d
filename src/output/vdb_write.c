#include "base/library.h"
#include "output/vdb.h"
#include "output/vdb_encode.h"

status vdb_volumes(const struct frame_grids *grids, const struct vdb_options *options, struct vdb_bytes *out)
{
    vdb_encode_volumes_function *encode = NULL;
    status st = library_find("vdb_encode_volumes", &encode);
    return st == OK ? library_said(encode(grids, options, out)) : st;
}

status vdb_points(const struct rock *rock, const struct vdb_options *options, struct vdb_bytes *out)
{
    vdb_encode_points_function *encode = NULL;
    status st = library_find("vdb_encode_points", &encode);
    return st == OK ? library_said(encode(rock, options, out)) : st;
}
