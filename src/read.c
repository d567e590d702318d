/* hoodoo-read: reads one OpenVDB or OpenEXR file in a sandbox, on behalf of hoodoo (reader/reader.h). */
#include "exr/serve.h"
#include "reader/serve.h"
#include "system/begin.h"
#include "vdb/serve.h"

enum { MEMORY = 1 << 30 };

int main(int argc, char **argv)
{
    static const struct serve_kind kinds[] = {
        {"vdb.check", MEMORY, vdb_serve_check},
        {"vdb.describe", MEMORY, vdb_serve_describe},
        {"vdb.lattices", MEMORY, vdb_serve_lattices},
        {"vdb.volumes", MEMORY, vdb_serve_volumes},
        {"vdb.points", MEMORY, vdb_serve_points},
        {"vdb.surface", MEMORY, vdb_serve_surface},
        {"vdb.at", MEMORY, vdb_serve_at},
        {"vdb.shape", MEMORY, vdb_serve_shape},
        {"exr.check", MEMORY, exr_serve_check},
        {"exr.describe", MEMORY, exr_serve_describe},
    };
    process_begin();
    return serve(argc, argv, kinds, sizeof kinds / sizeof *kinds);
}
