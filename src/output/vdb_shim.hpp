/* What the OpenVDB shims share: the turn between the simulator's axes and the file's, and files as bytes. */
#ifndef HOODOO_VDB_SHIM_HPP
#define HOODOO_VDB_SHIM_HPP

#include <openvdb/openvdb.h>

#include <cstddef>
#include <cstdint>
#include <new>
#include <string>

extern "C" {
#include "base/memory.h"
#include "base/text.h"
#include "base/version.h"
#include "output/vdb.h"
}

/* Ends a function-try-block: no exception crosses into C. `wrong` is what a failure other than of memory
 * means. */
#define SHIM_CATCH(wrong, subject)                                                                           \
    catch (const std::bad_alloc &)                                                                           \
    {                                                                                                        \
        return fail(E_MEMORY, "%s: out of memory", subject);                                                 \
    }                                                                                                        \
    catch (const std::exception &caught)                                                                     \
    {                                                                                                        \
        return fail(wrong, "%s: %s", subject, caught.what());                                                \
    }                                                                                                        \
    catch (...)                                                                                              \
    {                                                                                                        \
        return fail(wrong, "%s: unknown C++ exception", subject);                                            \
    }

namespace vdb
{
using openvdb::Coord;

/* y up: (x, y, z) in the simulator is (x, z, -y) in the file. A turn about x, so windings stay. */
template <class V> V file_from_sim(const V &s, bool y_up)
{
    return y_up ? V(s[0], s[2], 0 - s[1]) : s; /* not -s: no negative zeros */
}
template <class V> V sim_from_file(const V &f, bool y_up)
{
    return y_up ? V(f[0], 0 - f[2], f[1]) : f;
}

/* File metadata: how many voxels the frame's grids had, in the simulator's axes. */
constexpr char LATTICE[] = "lattice_voxels";

/* The frame's voxels in the file's index space: which box they fill, and where each is in the dense arrays.
 */
struct lattice {
    Coord lo, hi;        /* inclusive */
    ptrdiff_t stride[3]; /* voxels */
    bool y_up;

    lattice(const int n[3], bool y) : y_up(y)
    {
        const ptrdiff_t nx = n[0], layer = nx * n[1];
        if (y_up) {
            lo = Coord(0, 0, 1 - n[1]);
            hi = Coord(n[0] - 1, n[2] - 1, 0);
            stride[0] = 1, stride[1] = layer, stride[2] = -nx;
        } else {
            lo = Coord(0);
            hi = Coord(n[0] - 1, n[1] - 1, n[2] - 1);
            stride[0] = 1, stride[1] = nx, stride[2] = layer;
        }
    }
    ptrdiff_t at(int x, int y, int z) const
    {
        return x * stride[0] + y * stride[1] + z * stride[2];
    }
};

/* Registers OpenVDB's types once. */
void start();

/* The metadata of a file hoodoo writes. */
openvdb::MetaMap file_metadata(const vdb_options &options, double voxel);

/* Whether a file's metadata says y is up. Files by others than hoodoo are taken as y up if Houdini wrote
 * them. */
bool is_y_up(const openvdb::MetaMap &metadata);

/* The grids as a file in memory, with its archive UUID made from `identity` and the content. */
void encode(const openvdb::GridCPtrVec &grids, const vdb_options &options, const openvdb::MetaMap &metadata,
            vdb_bytes *out);

/* For files that say hoodoo wrote them: is the UUID the one encode() gave this content? */
bool is_intact(const void *bytes, size_t size);
} // namespace vdb

#endif
