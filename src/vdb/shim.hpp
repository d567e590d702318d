/* What the OpenVDB shims share: the turn between the simulator's axes and the file's, and files as bytes. */
#ifndef HOODOO_VDB_SHIM_HPP
#define HOODOO_VDB_SHIM_HPP

#include <openvdb/openvdb.h>
#include <openvdb/points/PointDataGrid.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <ios>
#include <new>
#include <string>
#include <vector>

extern "C" {
#include "base/memory.h"
#include "base/text.h"
#include "base/version.h"
#include "vdb/encode.h"
}

/* OpenVDB's library holds these classes whole, for it registers their grids. Without being told so, each file that names one
 * compiles all of it again, which took most of the time that hoodoo took to build. What the library has not kept of them are
 * small members that gcc compiles into whoever calls them; clang, and gcc without optimisation, would miss some. */
#if defined(__OPTIMIZE__) && !defined(__clang__)
namespace openvdb
{
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME
{
extern template class Grid<FloatTree>;
extern template class Grid<Vec3STree>;
extern template class Grid<points::PointDataTree>;
extern template class tree::Tree<FloatTree::RootNodeType>;
extern template class tree::Tree<Vec3STree::RootNodeType>;
extern template class tree::Tree<points::PointDataTree::RootNodeType>;
} // namespace OPENVDB_VERSION_NAME
} // namespace openvdb
#endif

/* Ends a function-try-block: no exception crosses into C. `wrong` is what a failure other than of memory
 * means. */
#define SHIM_CATCH(wrong, subject)                                                                           \
    catch (const std::bad_alloc &)                                                                           \
    {                                                                                                        \
        return fail(E_MEMORY, "%s: out of memory", subject);                                                 \
    }                                                                                                        \
    catch (const std::ios_base::failure &)                                                                   \
    {                                                                                                        \
        return fail(wrong, "%s: cut short or unreadable", subject);                                          \
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

/* Metadata of the file: how many voxels the frame's grids had, in the simulator's axes. Of a grid: how many
 * it had, where that is something else. */
constexpr char LATTICE[] = "lattice_voxels";

/* A lattice's samples in the file's index space: their box. */
struct lattice {
    Coord lo, hi; /* inclusive */
    bool y_up;

    /* `pad` more samples on every side; index 0 stays where it is. */
    lattice(const int n[3], bool y, int pad = 0) : y_up(y)
    {
        lo = y_up ? Coord(0, 0, 1 - n[1]) : Coord(0);
        hi = y_up ? Coord(n[0] - 1, n[2] - 1, 0) : Coord(n[0] - 1, n[1] - 1, n[2] - 1);
        lo.offset(-pad);
        hi.offset(pad);
    }
};

/* Registers OpenVDB's types once. */
void start();

/* The metadata of a file hoodoo writes. */
openvdb::MetaMap file_metadata(const vdb_options &options, double voxel);

/* Whether a file's metadata says y is up. Files by others are taken as y up if Houdini wrote them. */
bool is_y_up(const openvdb::MetaMap &metadata);

/* A file, read completely. */
struct file {
    openvdb::MetaMap::Ptr metadata;
    openvdb::GridPtrVecPtr grids;
    bool y_up;

    /* The first of that name, or nullptr. */
    openvdb::GridBase::Ptr grid(const std::string &name) const;
};

/* E_INPUT: it is not as it was written. Throws what the library throws. */
status load(const char *path, file *out);

/* Makes grid i, which is let go when it is written. */
using grid_maker = std::function<openvdb::GridBase::ConstPtr(size_t i)>;

/* So many grids, each with a name and a tree of its own, as a file in memory, with its archive UUID made from `identity` and the
 * content. */
void encode(size_t n_grids, const grid_maker &make, const vdb_options &options,
            const openvdb::MetaMap &metadata, vdb_bytes *out);

/* For files that say hoodoo wrote them: is the UUID the one encode() gave this content? */
bool is_intact(const void *bytes, size_t size);
} // namespace vdb

#endif
