/* Declarations shared by the OpenVDB shims: conversion between the simulator's axes and the file's, and encoding files. */
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
#include "base/version.h"
#include "text/text.h"
#include "vdb/encode.h"
}

/* OpenVDB's library contains instances of these classes, because it registers their grids. Without these declarations each source file
 * would instantiate them again, which took most of the build time. The library lacks only small members that optimising gcc inlines;
 * clang, and gcc without optimisation, would miss some of them. */
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

/* Ends a function-try-block, so that no exception crosses into C. `wrong` is the status for failures other than lack of memory. */
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

/* With y up, (x, y, z) in the simulator is (x, z, -y) in the file, a rotation about x, so triangles keep their orientation. */
template <class V> V file_from_sim(const V &s, bool y_up)
{
    return y_up ? V(s[0], s[2], 0 - s[1]) : s; /* 0 - s avoids negative zeros */
}
template <class V> V sim_from_file(const V &f, bool y_up)
{
    return y_up ? V(f[0], 0 - f[2], f[1]) : f;
}

/* Name of the metadata with the number of voxels along each axis, in the simulator's axes: of the file for the frame's grids, and of a
 * grid if its own differs. */
constexpr char LATTICE[] = "lattice_voxels";

/* The box of a lattice's samples in the file's index space. */
struct lattice {
    Coord lo, hi; /* inclusive */
    bool y_up;

    /* With `pad` more samples on every side; index 0 keeps its place. */
    lattice(const int n[3], bool y, int pad = 0) : y_up(y)
    {
        lo = y_up ? Coord(0, 0, 1 - n[1]) : Coord(0);
        hi = y_up ? Coord(n[0] - 1, n[2] - 1, 0) : Coord(n[0] - 1, n[1] - 1, n[2] - 1);
        lo.offset(-pad);
        hi.offset(pad);
    }
};

/* Registers OpenVDB's types; may be called repeatedly. */
void start();

/* The metadata of a file hoodoo writes. */
openvdb::MetaMap file_metadata(const vdb_options &options, double voxel);

/* Whether y is up, by the file's metadata. Files of other programs count as y up if Houdini wrote them. */
bool is_y_up(const openvdb::MetaMap &metadata);

/* A file that was read completely. */
struct file {
    openvdb::MetaMap::Ptr metadata;
    openvdb::GridPtrVecPtr grids;
    bool y_up;

    /* The first of that name, or nullptr. */
    openvdb::GridBase::Ptr grid(const std::string &name) const;
};

/* E_INPUT: the file is damaged. Also throws the library's exceptions. */
status load(const char *path, file *out);

/* Makes grid i, which is released after it was written. */
using grid_maker = std::function<openvdb::GridBase::ConstPtr(size_t i)>;

/* Thrown where a C function of this library failed and has set the message. */
struct refused {
    status st;
};

/* Encodes n_grids grids with different names and trees into an empty draft. The archive's UUID is made from `identity` and the content.
 * Throws refused. */
void encode(size_t n_grids, const grid_maker &make, const vdb_options &options,
            const openvdb::MetaMap &metadata, draft *out);

/* For files that claim to be written by hoodoo: whether the UUID matches the content. */
bool is_intact(const void *bytes, size_t size);
} // namespace vdb

#endif
