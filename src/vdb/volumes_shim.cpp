/* Makes OpenVDB grids of a frame's grids, leaf by leaf. */
#include "vdb/shim.hpp"

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

/* The index of samples in an array. Eight samples along x, starting at a multiple of eight, are adjacent. */
struct of_bricks {
    const frame_grids *grids;
    ptrdiff_t row(const Coord &s) const
    {
        return grid_row(grids, s[0], s[1], s[2]);
    }
};

/* For each kind of grid: which voxels are active, and the value of inactive ones. get() returns sample `at` of an array, which is sample s
 * of the lattice, in the simulator's axes; deep() the value of samples that are not kept because they are inside. */
struct level_set {
    using grid = openvdb::FloatGrid;
    const float *value;
    float background;
    bool cut(float d, float &v) const
    {
        v = d;
        if (std::fabs(v) < background)
            return true;
        v = v < 0 ? -background : background;
        return false;
    }
    bool get(ptrdiff_t at, const Coord &, float &v) const
    {
        return cut(value[at], v);
    }
    bool deep(const Coord &, float &v) const
    {
        return cut(-background, v);
    }
};
struct scalar {
    using grid = openvdb::FloatGrid;
    const float *value;
    const std::vector<uint8_t> &dense; /* a bit for each sample: whether it is active */
    const frame_grids *grids;
    const frame_grid *self;
    static constexpr float background = 0;
    bool get(ptrdiff_t at, const Coord &, float &v) const
    {
        const bool active = dense[size_t(at) / 8] >> (at % 8) & 1;
        v = active ? value[at] : 0;
        return active;
    }
    bool deep(const Coord &s, float &v) const
    {
        v = grid_inside(grids, self, grid_brick(grids, s[0], s[1], s[2]));
        return true;
    }
};
struct vector {
    using grid = openvdb::Vec3SGrid;
    const float *value;
    bool y_up;
    Vec3f background;
    bool get(ptrdiff_t at, const Coord &, Vec3f &v) const
    {
        v = vdb::file_from_sim(Vec3f(value[3 * at], value[3 * at + 1], value[3 * at + 2]), y_up);
        return v[0] != 0 || v[1] != 0 || v[2] != 0;
    }
    bool deep(const Coord &, Vec3f &v) const
    {
        v = Vec3f(0);
        return false;
    }
};

/* A solid that reaches the border of its grid, such as a mesh with a floor of its own, ends half a voxel beyond the outermost samples.
 * Otherwise the level set would not be closed, and its mesh would have a hole. */
struct closed_level_set : level_set {
    const frame_grids *grids;
    const frame_grid *self;

    ptrdiff_t row(const Coord &) const
    {
        return 0;
    }
    bool get(ptrdiff_t, const Coord &s, float &v) const
    {
        const int *n = grids->lattice.n;
        double inside = -1e30, outside = 0;
        int near[3];
        for (int a = 0; a < 3; a++) {
            const double d = std::max(-0.5 - s[a], s[a] - (n[a] - 0.5));
            inside = std::max(inside, d);
            outside += d > 0 ? d * d : 0;
            near[a] = std::min(std::max(s[a], 0), n[a] - 1);
        }
        const double box = outside > 0 ? std::sqrt(outside) : inside;
        return cut(
            std::max(grid_at(grids, self, near[0], near[1], near[2]), float(box * grids->lattice.voxel)), v);
    }
};

bool reaches_border(const frame_grids &grids, const frame_grid &g)
{
    const int *n = grids.lattice.n;
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        for (int side = 0; side < n[a]; side += std::max(1, n[a] - 1))
            for (int i = 0; i < n[b]; i++)
                for (int j = 0; j < n[c]; j++) {
                    int s[3];
                    s[a] = side, s[b] = i, s[c] = j;
                    if (grid_at(&grids, &g, s[0], s[1], s[2]) < 0)
                        return true;
                }
    }
    return false;
}

template <class place, class field>
typename field::grid::Ptr sparse_grid(const lattice &l, const place &p, const field &f)
{
    using tree = typename field::grid::TreeType;
    using leaf = typename tree::LeafNodeType;
    using value = typename tree::ValueType;
    constexpr int D = leaf::DIM;
    static_assert(D == BRICK_SIDE, "a row of a leaf lies in one brick");
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
                bool any = false; /* most leaves of a large box with little rock are empty */
                for (int y = b[1]; y <= e[1] && !any; y++)
                    for (int z = b[2]; z <= e[2] && !any; z++)
                        any = p.row(vdb::sim_from_file(o.offsetBy(b[0], y, z), l.y_up)) != ROW_OUTSIDE;
                if (!any)
                    continue;
                typename leaf::NodeMaskType mask;
                for (value &v : block)
                    v = f.background;
                for (int y = b[1]; y <= e[1]; y++)
                    for (int z = b[2]; z <= e[2]; z++) {
                        Coord s = vdb::sim_from_file(o.offsetBy(b[0], y, z), l.y_up);
                        const ptrdiff_t row = p.row(s);
                        if (row == ROW_OUTSIDE)
                            continue;
                        for (int x = b[0]; x <= e[0]; x++, s[0]++) {
                            const openvdb::Index at = openvdb::Index(x << 6 | y << 3 | z);
                            if (row == ROW_INSIDE ? f.deep(s, block[at])
                                                  : f.get(row + x - b[0], s, block[at]))
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

/* The samples that are not 0, a bit for each. */
std::vector<uint8_t> nonzero(const frame_grids &grids, const frame_grid &g)
{
    std::vector<uint8_t> bits(grids.bricks.count * BRICK_SAMPLES / 8);
    for (size_t i = 0; i < bits.size(); i++)
        for (size_t b = 0; b < 8; b++)
            bits[i] = uint8_t(bits[i] | (g.value[8 * i + b] != 0) << b);
    return bits;
}

/* A grid with its samples in memory: the frame's, or read from the grids' source for the lifetime of this object. */
class sampled
{
  public:
    sampled(const frame_grids &grids, const frame_grid &g) : grid(g)
    {
        const status st = g.value ? OK : grids.source.read(grids.source.user, &g, &own_);
        if (st != OK)
            throw vdb::refused{st};
        if (own_)
            grid.value = own_;
    }
    sampled(const sampled &) = delete;
    sampled &operator=(const sampled &) = delete;
    ~sampled()
    {
        std::free(own_);
    }
    frame_grid grid;

  private:
    float *own_ = nullptr;
};

/* Samples of air that a closed level set gets on every side. */
constexpr int PAD = 4;

openvdb::GridBase::Ptr make_grid(const frame_grids &grids, const frame_grid &g, const lattice &l,
                                 const std::vector<uint8_t> &dense)
{
    const of_bricks p{&grids};
    if (g.components == 3) {
        auto grid = sparse_grid(l, p, vector{g.value, l.y_up, Vec3f(0)});
        grid->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
        return grid;
    }
    auto grid = sparse_grid(l, p, scalar{g.value, dense.empty() ? nonzero(grids, g) : dense, &grids, &g});
    grid->setGridClass(g.kind == GRID_FOG ? openvdb::GRID_FOG_VOLUME : openvdb::GRID_UNKNOWN);
    return grid;
}

openvdb::GridBase::Ptr make_level_set(const frame_grids &grids, const frame_grid &g, bool y_up)
{
    const level_set open{g.value, grid_background(&grids, &g)};
    openvdb::FloatGrid::Ptr grid;
    if (reaches_border(grids, g)) {
        const closed_level_set closed{open, &grids, &g};
        grid = sparse_grid(lattice(grids.lattice.n, y_up, PAD), closed, closed);
    } else {
        grid = sparse_grid(lattice(grids.lattice.n, y_up), of_bricks{&grids}, open);
    }
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    return grid;
}

/* Whether the values fit into halves, whose largest is 65,504. */
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
        return fail(E_OUTPUT, "volumes of frame %d: voxels must not be %g m", frame, l.voxel);
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
                                     struct draft *out)
try {
    vdb::start();
    const grid_lattice &frame_lattice = grids->lattice;
    const status st = check_lattice(frame_lattice, options->frame);
    if (st != OK)
        return st;

    const bool y_up = options->up == OUTPUT_UP_Y;
    const lattice common(frame_lattice.n, y_up);
    std::vector<uint8_t> dense;
    for (size_t i = 0; i < grids->n_grids; i++)
        if (std::strcmp(grids->grid[i].name, "density") == 0)
            dense = nonzero(*grids, sampled(*grids, grids->grid[i]).grid);

    openvdb::MetaMap metadata = vdb::file_metadata(*options, frame_lattice.voxel);
    metadata.insertMeta(vdb::LATTICE, openvdb::Vec3IMetadata(openvdb::Vec3i(frame_lattice.n)));
    const auto transform = transform_of(frame_lattice, y_up);
    const auto make = [&](size_t i) {
        const sampled in_memory(*grids, grids->grid[i]);
        const frame_grid &g = in_memory.grid;
        auto grid =
            g.kind == GRID_LEVEL_SET ? make_level_set(*grids, g, y_up) : make_grid(*grids, g, common, dense);
        grid->setName(g.name);
        grid->setCreator(metadata.metaValue<std::string>("creator"));
        grid->setTransform(transform);
        grid->setSaveFloatAsHalf(options->half && fits_half(g));
        if (g.unit && *g.unit)
            grid->insertMeta("unit", openvdb::StringMetadata(g.unit));
        return grid;
    };
    vdb::encode(grids->n_grids, make, *options, metadata, out);
    return OK;
} catch (const vdb::refused &r) {
    return r.st;
}
SHIM_CATCH(E_OUTPUT, "volumes")
