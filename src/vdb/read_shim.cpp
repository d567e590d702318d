/* Checks and describes OpenVDB files. Runs in hoodoo-read, with a single thread, because the files may be hostile. */
#include "vdb/shim.hpp"

#include <openvdb/io/File.h>
#include <openvdb/io/Stream.h>

#include <cstdlib>
#include <istream>
#include <memory>
#include <streambuf>

extern "C" {
#include "reader/describe.h"
#include "system/atomic_file.h"
#include "vdb/serve.h"
}

namespace
{
using openvdb::GridBase;
using openvdb::Index64;
using openvdb::points::PointDataGrid;

/* Counts active values, which are in leaves or are tiles, without OpenVDB's threads. */
template <class tree_type> Index64 count_active(const tree_type &tree)
{
    Index64 n = 0;
    auto tile = tree.cbeginValueOn();
    tile.setMaxDepth(tree_type::ValueOnCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile)
        n += tile.getVoxelCount();
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf)
        n += leaf->onVoxelCount();
    return n;
}

void describe_points(const PointDataGrid &grid, struct text *out)
{
    Index64 n = 0;
    const openvdb::points::AttributeSet *set = nullptr;
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        n += leaf->getLastValue();
        set = &leaf->attributeSet();
    }
    json_integer(out, "points", int64_t(n));
    json_array(out, "attributes");
    if (set) {
        /* by position, which is the order in which they were created */
        for (size_t i = 0; i < set->size(); i++)
            for (const auto &entry : set->descriptor().map())
                if (entry.second == i) {
                    const auto &type = set->descriptor().type(i);
                    json_object(out, nullptr);
                    json_text(out, "name", entry.first.c_str());
                    json_text(out, "type", type.first.c_str());
                    json_text(out, "codec", type.second.c_str());
                    json_end_object(out);
                }
    }
    json_end_array(out);
}

struct count_voxels {
    Index64 n = 0;
    template <class grid_type> void operator()(const grid_type &grid)
    {
        n = count_active(grid.tree());
    }
};

using known_grids = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid,
                                      openvdb::Int64Grid, openvdb::BoolGrid, openvdb::MaskGrid,
                                      openvdb::Vec3SGrid, openvdb::Vec3DGrid, openvdb::Vec3IGrid>;

void json_vector(struct text *out, const char *key, const openvdb::Vec3d &v)
{
    json_array(out, key);
    for (int a = 0; a < 3; a++)
        json_number(out, nullptr, v[a]);
    json_end_array(out);
}

void describe_metadata(const openvdb::MetaMap &metadata, const char *key, struct text *out)
{
    json_object(out, key);
    for (auto m = metadata.beginMeta(); m != metadata.endMeta(); ++m) {
        const openvdb::Metadata &value = *m->second;
        if (const auto *d = dynamic_cast<const openvdb::DoubleMetadata *>(&value))
            json_number(out, m->first.c_str(), d->value());
        else if (const auto *f = dynamic_cast<const openvdb::FloatMetadata *>(&value))
            json_number(out, m->first.c_str(), double(f->value()));
        else if (const auto *i = dynamic_cast<const openvdb::Int32Metadata *>(&value))
            json_integer(out, m->first.c_str(), i->value());
        else if (const auto *l = dynamic_cast<const openvdb::Int64Metadata *>(&value))
            json_integer(out, m->first.c_str(), l->value());
        else if (const auto *b = dynamic_cast<const openvdb::BoolMetadata *>(&value))
            json_bool(out, m->first.c_str(), b->value());
        else
            json_text(out, m->first.c_str(), value.str().c_str());
    }
    json_end_object(out);
}

void describe_grid(const GridBase &grid, struct text *out)
{
    json_object(out, nullptr);
    json_text(out, "name", grid.getName().c_str());
    json_text(out, "type", grid.valueType().c_str());
    json_text(out, "class", GridBase::gridClassToString(grid.getGridClass()).c_str());
    json_bool(out, "half", grid.saveFloatAsHalf());
    json_vector(out, "voxel_m", grid.voxelSize());
    if (grid.isType<PointDataGrid>())
        describe_points(static_cast<const PointDataGrid &>(grid), out);
    count_voxels active;
    if (grid.apply<known_grids>(active))
        json_integer(out, "active_voxels", int64_t(active.n));
    /* Samples are at the centres of voxels; points are up to half a voxel away from theirs. */
    openvdb::CoordBBox box;
    if (grid.baseTree().evalActiveVoxelBoundingBox(box)) {
        const double reach = grid.isType<PointDataGrid>() ? 0.5 : 0;
        const openvdb::BBoxd bounds = grid.transform().indexToWorld(
            openvdb::BBoxd(box.min().asVec3d() - reach, box.max().asVec3d() + reach));
        json_object(out, "bounds_m");
        json_vector(out, "min", bounds.min());
        json_vector(out, "max", bounds.max());
        json_end_object(out);
    }
    describe_metadata(grid, "metadata", out);
    json_end_object(out);
}

/* A stream over bytes in memory. */
struct memory_source : std::streambuf {
    memory_source(char *bytes, size_t n)
    {
        setg(bytes, bytes, bytes + n);
    }
    pos_type seekoff(off_type off, std::ios_base::seekdir way, std::ios_base::openmode) override
    {
        const off_type base = way == std::ios_base::beg   ? 0
                              : way == std::ios_base::cur ? gptr() - eback()
                                                          : egptr() - eback();
        if (base + off < 0 || base + off > egptr() - eback())
            return pos_type(off_type(-1));
        setg(eback(), eback() + base + off, egptr());
        return pos_type(base + off);
    }
    pos_type seekpos(pos_type pos, std::ios_base::openmode which) override
    {
        return seekoff(off_type(pos), std::ios_base::beg, which);
    }
};

/* Describes the lattice, whose size is in the metadata of the file. */
void describe_lattice(const GridBase &grid, const openvdb::MetaMap &file, struct text *out)
{
    const auto size = file.getMetadata<openvdb::Vec3IMetadata>(vdb::LATTICE);
    json_object(out, nullptr);
    json_text(out, "name", grid.getName().c_str());
    json_text(out, "type", grid.valueType().c_str());
    json_text(out, "class", GridBase::gridClassToString(grid.getGridClass()).c_str());
    if (size) {
        const openvdb::Vec3i n = size->value();
        const vdb::lattice l(n.asPointer(), vdb::is_y_up(file));
        const openvdb::BBoxd bounds =
            grid.transform().indexToWorld(openvdb::BBoxd(l.lo.asVec3d() - 0.5, l.hi.asVec3d() + 0.5));
        json_object(out, "bounds_m");
        json_vector(out, "min", bounds.min());
        json_vector(out, "max", bounds.max());
        json_end_object(out);
    }
    json_end_object(out);
}
} // namespace

/* The library does not detect a truncated file, but the stream throws an exception. */
status vdb::load(const char *path, vdb::file *out)
{
    void *bytes = nullptr;
    size_t size = 0;
    const status st = file_read(path, SIZE_MAX / 2, &bytes, &size);
    if (st != OK)
        return st;
    const std::unique_ptr<void, decltype(&std::free)> owner(bytes, std::free);
    vdb::start();
    memory_source source(static_cast<char *>(bytes), size);
    std::istream is(&source);
    is.exceptions(std::ios::eofbit | std::ios::failbit | std::ios::badbit);
    openvdb::io::Stream stream(is, /*delayLoad=*/false);
    if (!vdb::is_intact(bytes, size))
        return fail(E_INPUT, "%s: damaged: its content does not match its hash", path);
    out->metadata = stream.getMetadata();
    out->grids = stream.getGrids();
    out->y_up = vdb::is_y_up(*out->metadata);
    return OK;
}

GridBase::Ptr vdb::file::grid(const std::string &name) const
{
    for (const GridBase::Ptr &g : *grids)
        if (g->getName() == name)
            return g;
    return nullptr;
}

extern "C" status vdb_serve_check(const struct serve_question *q, struct serve_answer *)
try {
    vdb::file file;
    return vdb::load(q->path, &file);
}
SHIM_CATCH(E_INPUT, q->path)

extern "C" status vdb_serve_describe(const struct serve_question *q, struct serve_answer *answer)
try {
    vdb::file file;
    const status st = vdb::load(q->path, &file);
    if (st != OK)
        return st;
    struct text out;
    describe_begin(q, &out);
    json_text(&out, "up_axis", file.y_up ? "y" : "z");
    describe_metadata(*file.metadata, "metadata", &out);
    json_array(&out, "grids");
    for (const GridBase::Ptr &grid : *file.grids)
        describe_grid(*grid, &out);
    json_end_array(&out);
    return describe_end(&out, answer);
}
SHIM_CATCH(E_INPUT, q->path)

extern "C" status vdb_serve_lattices(const struct serve_question *q, struct serve_answer *answer)
try {
    vdb::start();
    openvdb::io::File file(q->path);
    file.open(/*delayLoad=*/false);
    const openvdb::GridPtrVecPtr grids = file.readAllGridMetadata();
    const openvdb::MetaMap::Ptr metadata = file.getMetadata();
    struct text out;
    describe_begin(q, &out);
    json_object(&out, nullptr);
    json_array(&out, "grids");
    for (const GridBase::Ptr &grid : *grids)
        describe_lattice(*grid, *metadata, &out);
    json_end_array(&out);
    json_end_object(&out);
    return describe_end(&out, answer);
}
SHIM_CATCH(E_INPUT, q->path)
