/* Frames back from their files: volumes as dense grids, points as particles. */
#include "output/vdb_shim.hpp"

#include <openvdb/io/File.h>
#include <openvdb/points/AttributeArray.h>
#include <openvdb/points/PointDataGrid.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace
{
using openvdb::Coord;
using openvdb::Vec3d;
using openvdb::Vec3f;
using openvdb::points::PointDataGrid;

/* A dense array's worth of voxels is more than a file of this size can mean. */
void check_size(size_t voxels, size_t components)
{
    if (voxels > memory_available() / sizeof(float) / components)
        throw std::runtime_error("its grids are larger than this machine's memory");
}

/* The grid's voxels in the lattice: leaves voxel by voxel, tiles by their value. */
template <class grid_type, class store_fn>
void read_dense(const grid_type &grid, const vdb::lattice &l, const store_fn &store)
{
    constexpr int D = grid_type::TreeType::LeafNodeType::DIM;
    const Coord first = l.lo & ~(D - 1);
    const size_t my = size_t((l.hi[1] - first[1]) / D + 1), mz = size_t((l.hi[2] - first[2]) / D + 1);
    tbb::parallel_for(tbb::blocked_range<size_t>(0, my * mz), [&](const tbb::blocked_range<size_t> &range) {
        auto at = grid.getConstAccessor();
        for (size_t r = range.begin(); r < range.end(); r++)
            for (Coord o = first.offsetBy(0, int(r % my) * D, int(r / my) * D); o[0] <= l.hi[0]; o[0] += D) {
                const auto *leaf = at.probeConstLeaf(o);
                const auto tile = leaf ? grid.background() : at.getValue(o);
                const Coord b = Coord::maxComponent(o, l.lo),
                            e = Coord::minComponent(o.offsetBy(D - 1), l.hi);
                for (int y = b[1]; y <= e[1]; y++)
                    for (int z = b[2]; z <= e[2]; z++)
                        for (int x = b[0]; x <= e[0]; x++)
                            store(l.at(x, y, z), leaf ? leaf->getValue(Coord(x, y, z)) : tile);
            }
    });
}

void read_grid(const openvdb::GridBase &base, const vdb::lattice &l, frame_grid &g, size_t voxels)
{
    const bool is_vector = base.isType<openvdb::Vec3SGrid>();
    if (!is_vector && !base.isType<openvdb::FloatGrid>())
        throw std::runtime_error(std::string("grid '") + g.name + "' does not hold floats");
    g.components = is_vector ? 3 : 1;
    g.kind = base.getGridClass() == openvdb::GRID_LEVEL_SET    ? GRID_LEVEL_SET
             : base.getGridClass() == openvdb::GRID_FOG_VOLUME ? GRID_FOG
                                                               : GRID_PLAIN;
    check_size(voxels, size_t(g.components));
    g.value = static_cast<float *>(std::malloc(voxels * size_t(g.components) * sizeof(float)));
    if (!g.value)
        throw std::bad_alloc();
    float *to = g.value;
    if (is_vector)
        read_dense(static_cast<const openvdb::Vec3SGrid &>(base), l, [&](ptrdiff_t i, const Vec3f &v) {
            const Vec3f s = vdb::sim_from_file(v, l.y_up);
            to[3 * i] = s[0], to[3 * i + 1] = s[1], to[3 * i + 2] = s[2];
        });
    else
        read_dense(static_cast<const openvdb::FloatGrid &>(base), l,
                   [to](ptrdiff_t i, float v) { to[i] = v; });
}

/* A lattice's size as a file gives it, and how many voxels that is. */
size_t set_size(int n[3], const openvdb::Vec3i &size)
{
    for (int a = 0; a < 3; a++) {
        n[a] = size[a];
        if (n[a] < 1 || n[a] > 1 << 20)
            throw std::runtime_error("its grids have no sensible size");
    }
    return size_t(n[0]) * size_t(n[1]) * size_t(n[2]);
}

/* A particle file being read: its leaves, and where each leaf's particles start. */
struct point_leaves {
    std::vector<const openvdb::points::PointDataTree::LeafNodeType *> leaf;
    std::vector<size_t> begin{0};

    explicit point_leaves(const PointDataGrid &grid)
    {
        for (auto l = grid.tree().cbeginLeaf(); l; ++l) {
            l->validateOffsets();
            leaf.push_back(&*l);
            begin.push_back(begin.back() + l->getLastValue());
        }
    }
    template <class work_fn> void each(const work_fn &work) const
    {
        tbb::parallel_for(tbb::blocked_range<size_t>(0, leaf.size()),
                          [&](const tbb::blocked_range<size_t> &range) {
                              for (size_t i = range.begin(); i < range.end(); i++)
                                  work(*leaf[i], begin[i]);
                          });
    }
};

template <class T, class store_fn>
void read_attribute(const point_leaves &leaves, const std::string &name, const store_fn &store)
{
    leaves.each([&](const auto &leaf, size_t begin) {
        const openvdb::points::AttributeHandle<T> handle(leaf.constAttributeArray(name));
        for (openvdb::Index i = 0; i < leaf.getLastValue(); i++)
            store(begin + i, handle.get(i));
    });
}

void read_field(const point_leaves &leaves, enum rock_field f, bool y_up, struct rock &rock)
{
    const rock_field_info &info = rock_field_table[f];
    rock.field[f] = std::calloc(rock.n + 1, rock_field_size(f));
    if (!rock.field[f])
        throw std::bad_alloc();
    float *real = static_cast<float *>(rock.field[f]);
    uint32_t *whole = static_cast<uint32_t *>(rock.field[f]);
    if (info.components == 4)
        read_attribute<Vec3f>(leaves, info.vdb, [real, y_up](size_t i, const Vec3f &v) {
            const Vec3f s = vdb::sim_from_file(v, y_up);
            real[4 * i] = s[0], real[4 * i + 1] = s[1], real[4 * i + 2] = s[2];
        });
    else if (info.is_float)
        read_attribute<float>(leaves, info.vdb, [real](size_t i, float v) { real[i] = v; });
    else
        read_attribute<int32_t>(leaves, info.vdb, [whole](size_t i, int32_t v) { whole[i] = uint32_t(v); });
}

void read_positions(const point_leaves &leaves, const PointDataGrid &grid, bool y_up, float *P)
{
    const auto &transform = grid.transform();
    leaves.each([&](const auto &leaf, size_t begin) {
        const openvdb::points::AttributeHandle<Vec3f> handle(leaf.constAttributeArray("P"));
        for (auto i = leaf.beginIndexOn(); i; ++i) {
            const Vec3d x = transform.indexToWorld(Vec3d(handle.get(*i)) + i.getCoord().asVec3d());
            const Vec3d s = vdb::sim_from_file(x, y_up);
            for (size_t a = 0; a < 3; a++)
                P[4 * (begin + *i) + a] = float(s[int(a)]);
        }
    });
}
} // namespace

extern "C" status vdb_volumes_read(const char *path, struct frame_grids *out)
try {
    *out = frame_grids{};
    const status st = vdb_check(path);
    if (st != OK)
        return st;
    vdb::start();
    openvdb::io::File file(path);
    file.open(/*delayLoad=*/false);
    struct owner {
        frame_grids grids{};
        ~owner()
        {
            vdb_volumes_free(&grids);
        }
    } made;
    frame_grids &grids = made.grids;
    const auto size = file.getMetadata()->getMetadata<openvdb::Vec3IMetadata>(vdb::LATTICE);
    if (!size)
        throw std::runtime_error(
            "not a volume file of hoodoo: it does not say how many voxels its grids have");
    const size_t voxels = set_size(grids.n, size->value());
    const bool y_up = vdb::is_y_up(*file.getMetadata());
    const vdb::lattice l(grids.n, y_up);
    for (int v = 1; v < VALUES; v++) {
        if (!(value_table[v].where & IN_VOLUMES) || !file.hasGrid(value_table[v].name))
            continue;
        const auto base = file.readGrid(value_table[v].name);
        const Vec3d origin = vdb::sim_from_file(base->transform().indexToWorld(Vec3d(0)), y_up);
        const auto own = base->getMetadata<openvdb::Vec3IMetadata>(vdb::LATTICE);
        frame_grid *added = nullptr;
        const status full = frame_grids_add(&grids, static_cast<enum value_id>(v), &added);
        if (full != OK)
            return full;
        frame_grid &g = *added;
        (own ? g.own.voxel : grids.voxel) = base->voxelSize()[0];
        for (int a = 0; a < 3; a++)
            (own ? g.own.origin : grids.origin)[a] = origin[a];
        if (own) {
            const size_t n = set_size(g.own.n, own->value());
            read_grid(*base, vdb::lattice(g.own.n, y_up), g, n);
        } else {
            read_grid(*base, l, g, voxels);
        }
    }
    *out = grids;
    grids = frame_grids{};
    return OK;
}
SHIM_CATCH(E_INPUT, path)

extern "C" void vdb_volumes_free(struct frame_grids *grids)
{
    for (size_t i = 0; i < grids->n_grids; i++)
        std::free(grids->grid[i].value);
    *grids = frame_grids{};
}

extern "C" status vdb_points_read(const char *path, struct rock *out)
try {
    std::memset(out, 0, sizeof *out);
    const status st = vdb_check(path);
    if (st != OK)
        return st;
    vdb::start();
    openvdb::io::File file(path);
    file.open(/*delayLoad=*/false);
    const bool y_up = vdb::is_y_up(*file.getMetadata());
    const auto grid =
        file.hasGrid("points") ? openvdb::gridPtrCast<PointDataGrid>(file.readGrid("points")) : nullptr;
    if (!grid)
        throw std::runtime_error("it holds no points");
    struct owner {
        struct rock rock = {};
        ~owner()
        {
            rock_free(&rock);
        }
    } made;
    const point_leaves leaves(*grid);
    made.rock.n = leaves.begin.back();
    for (int f = 0; f < ROCK_FIELDS; f++)
        if (f != ROCK_P && *rock_field_table[f].vdb &&
            (leaves.leaf.empty() || leaves.leaf[0]->hasAttribute(rock_field_table[f].vdb)))
            read_field(leaves, static_cast<enum rock_field>(f), y_up, made.rock);
    made.rock.P = static_cast<float *>(std::calloc(made.rock.n + 1, 4 * sizeof(float)));
    if (!made.rock.P)
        throw std::bad_alloc();
    read_positions(leaves, *grid, y_up, made.rock.P);
    *out = made.rock;
    std::memset(static_cast<void *>(&made.rock), 0, sizeof made.rock);
    return OK;
}
SHIM_CATCH(E_INPUT, path)
