/* Dense frame grids to sparse OpenVDB grids, leaf by leaf. */
#include "output/vdb_shim.hpp"

#include <openvdb/tools/Prune.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <cstring>
#include <vector>

namespace
{
using openvdb::Coord;
using openvdb::Vec3f;
using vdb::lattice;

/* What a kind of grid means by active, and what its inactive voxels hold. */
struct level_set {
    using grid = openvdb::FloatGrid;
    const float *value;
    float background;
    bool get(ptrdiff_t i, float &v) const
    {
        v = value[i];
        if (std::fabs(v) < background)
            return true;
        v = v < 0 ? -background : background;
        return false;
    }
};
struct scalar {
    using grid = openvdb::FloatGrid;
    const float *value, *density;
    float background;
    bool get(ptrdiff_t i, float &v) const
    {
        const bool active = density[i] != 0;
        v = active ? value[i] : 0;
        return active;
    }
};
struct vector {
    using grid = openvdb::Vec3SGrid;
    const float *value;
    bool y_up;
    Vec3f background;
    bool get(ptrdiff_t i, Vec3f &v) const
    {
        v = vdb::file_from_sim(Vec3f(value[3 * i], value[3 * i + 1], value[3 * i + 2]), y_up);
        return v[0] != 0 || v[1] != 0 || v[2] != 0;
    }
};

template <class field> typename field::grid::Ptr sparse_grid(const lattice &l, const field &f)
{
    using tree = typename field::grid::TreeType;
    using leaf = typename tree::LeafNodeType;
    using value = typename tree::ValueType;
    constexpr int D = leaf::DIM;
    const Coord first = l.lo & ~(D - 1);
    const int m[3] = {(l.hi[0] - first[0]) / D + 1, (l.hi[1] - first[1]) / D + 1,
                      (l.hi[2] - first[2]) / D + 1};
    const size_t n_leaves = size_t(m[0]) * size_t(m[1]) * size_t(m[2]);
    const auto origin = [&](size_t i) {
        const size_t mx = size_t(m[0]), my = size_t(m[1]);
        return first.offsetBy(int(i % mx) * D, int(i / mx % my) * D, int(i / mx / my) * D);
    };
    std::vector<std::unique_ptr<leaf>> leaves(n_leaves);
    enum : char { EMPTY, LEAF, TILE, TILE_ON };
    std::vector<char> is(n_leaves, EMPTY);
    std::vector<value> tile(n_leaves, f.background);

    tbb::parallel_for(
        tbb::blocked_range<size_t>(0, n_leaves, 16), [&](const tbb::blocked_range<size_t> &range) {
            value block[leaf::SIZE];
            for (size_t i = range.begin(); i < range.end(); i++) {
                const Coord o = origin(i);
                const Coord b = Coord::maxComponent(o, l.lo) - o,
                            e = Coord::minComponent(o.offsetBy(D - 1), l.hi) - o;
                typename leaf::NodeMaskType mask;
                for (value &v : block)
                    v = f.background;
                for (int y = b[1]; y <= e[1]; y++)
                    for (int z = b[2]; z <= e[2]; z++) {
                        const ptrdiff_t row = l.at(o[0], o[1] + y, o[2] + z);
                        for (int x = b[0]; x <= e[0]; x++) {
                            const openvdb::Index at = openvdb::Index(x << 6 | y << 3 | z);
                            if (f.get(row + x * l.stride[0], block[at]))
                                mask.setOn(at);
                        }
                    }
                bool flat = mask.isOn() || mask.isOff();
                for (size_t v = 1; flat && v < leaf::SIZE; v++)
                    flat = block[v] == block[0];
                if (flat && mask.isOff() && block[0] == f.background)
                    continue;
                tile[i] = block[0];
                is[i] = !flat ? LEAF : mask.isOn() ? TILE_ON : TILE;
                if (flat)
                    continue;
                leaves[i].reset(new leaf(o, f.background));
                std::memcpy(static_cast<void *>(leaves[i]->buffer().data()), block, sizeof block);
                leaves[i]->setValueMask(mask);
            }
        });

    auto grid = field::grid::create(f.background);
    for (size_t i = 0; i < n_leaves; i++)
        if (is[i] == LEAF)
            grid->tree().addLeaf(leaves[i].release());
        else if (is[i] != EMPTY)
            grid->tree().addTile(1, origin(i), tile[i], is[i] == TILE_ON);
    openvdb::tools::prune(grid->tree());
    return grid;
}

openvdb::GridBase::Ptr make_grid(const frame_grids &grids, const frame_grid &g, const lattice &l,
                                 const float *density)
{
    if (g.components == 3) {
        auto grid = sparse_grid(l, vector{g.value, l.y_up, Vec3f(0)});
        grid->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
        return grid;
    }
    if (g.kind == GRID_LEVEL_SET) {
        const std::vector<float> closed = vdb::close_at_border(g.value, grids.n, grids.voxel);
        const float background = float(3 * grids.voxel);
        auto grid = closed.empty() ? sparse_grid(l, level_set{g.value, background})
                                   : sparse_grid(lattice(grids.n, l.y_up, vdb::PAD),
                                                 level_set{closed.data(), background});
        grid->setGridClass(openvdb::GRID_LEVEL_SET);
        return grid;
    }
    auto grid = sparse_grid(l, scalar{g.value, density ? density : g.value, 0});
    grid->setGridClass(g.kind == GRID_FOG ? openvdb::GRID_FOG_VOLUME : openvdb::GRID_UNKNOWN);
    return grid;
}

/* Halves end at 65,504: some values go beyond. */
bool fits_half(const frame_grid &g)
{
    const enum value_id v = value_of_name(g.name);
    return v == VALUE_NONE || value_table[v].bits != BITS_EXACT;
}

status check_lattice(const grid_lattice &l, int frame)
{
    for (int a = 0; a < 3; a++)
        if (l.n[a] < 1 || !std::isfinite(l.origin[a]))
            return fail(E_OUTPUT, "volumes of frame %d: %d x %d x %d voxels is not a grid", frame, l.n[0],
                        l.n[1], l.n[2]);
    if (!(l.voxel > 0) || !std::isfinite(l.voxel))
        return fail(E_OUTPUT, "volumes of frame %d: a voxel of %g m", frame, l.voxel);
    return OK;
}

openvdb::math::Transform::Ptr transform_of(const grid_lattice &l, bool y_up)
{
    auto transform = openvdb::math::Transform::createLinearTransform(l.voxel);
    transform->postTranslate(vdb::file_from_sim(openvdb::Vec3d(l.origin[0], l.origin[1], l.origin[2]), y_up));
    return transform;
}
} // namespace

extern "C" status vdb_encode_volumes(const struct frame_grids *grids, const struct vdb_options *options,
                                     struct vdb_bytes *out)
try {
    vdb::start();
    *out = vdb_bytes{nullptr, 0};
    const grid_lattice frame_lattice = {{grids->n[0], grids->n[1], grids->n[2]},
                                        grids->voxel,
                                        {grids->origin[0], grids->origin[1], grids->origin[2]}};
    status st = check_lattice(frame_lattice, options->frame);
    for (size_t i = 0; i < grids->n_grids && st == OK; i++)
        if (grids->grid[i].own.n[0])
            st = check_lattice(grids->grid[i].own, options->frame);
    if (st != OK)
        return st;

    const bool y_up = options->up == OUTPUT_UP_Y;
    const lattice common(grids->n, y_up);
    const float *density = nullptr;
    for (size_t i = 0; i < grids->n_grids; i++)
        if (std::strcmp(grids->grid[i].name, "density") == 0)
            density = grids->grid[i].value;

    openvdb::MetaMap metadata = vdb::file_metadata(*options, grids->voxel);
    metadata.insertMeta(vdb::LATTICE, openvdb::Vec3IMetadata(openvdb::Vec3i(grids->n)));
    const auto transform = transform_of(frame_lattice, y_up);
    openvdb::GridCPtrVec made;
    for (size_t i = 0; i < grids->n_grids; i++) {
        const frame_grid &g = grids->grid[i];
        const bool own = g.own.n[0] != 0;
        auto grid = make_grid(*grids, g, own ? lattice(g.own.n, y_up) : common, own ? nullptr : density);
        grid->setName(g.name);
        if (own)
            grid->insertMeta(vdb::LATTICE, openvdb::Vec3IMetadata(openvdb::Vec3i(g.own.n)));
        grid->setCreator(metadata.metaValue<std::string>("creator"));
        grid->setTransform(own ? transform_of(g.own, y_up) : transform);
        grid->setSaveFloatAsHalf(options->half && fits_half(g));
        if (g.unit && *g.unit)
            grid->insertMeta("unit", openvdb::StringMetadata(g.unit));
        made.push_back(grid);
    }
    vdb::encode(made, *options, metadata, out);
    return OK;
}
SHIM_CATCH(E_OUTPUT, "volumes")
