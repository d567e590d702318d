/* Frames back from their files: volumes as dense grids, points as particles. Runs in hoodoo-read. */
#include "output/vdb_shim.hpp"

#include <openvdb/points/AttributeArray.h>
#include <openvdb/points/PointDataGrid.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

extern "C" {
#include "output/vdb_serve.h"
}

namespace
{
using openvdb::Coord;
using openvdb::Vec3d;
using openvdb::Vec3f;
using openvdb::points::PointDataGrid;

/* The answer cannot be given. */
struct failure : std::exception {
};
void must(status st)
{
    if (st != OK)
        throw failure();
}

/* The grid's voxels in the lattice, as layers of it from the ground up: leaves voxel by voxel, tiles by their value. What has
 * one layer of leaves in memory at a time sends a grid that is much larger than its file. */
template <class grid_type, class store_fn>
void send_dense(const grid_type &grid, const vdb::lattice &l, size_t components, const store_fn &store,
                struct serve_answer *answer)
{
    constexpr int D = grid_type::TreeType::LeafNodeType::DIM;
    const int up = l.y_up ? 1 : 2; /* the file's axis along which the simulator's layers lie */
    const ptrdiff_t layer = l.stride[up];
    auto at = grid.getConstAccessor();
    std::vector<float> slab;
    must(serve_part(answer));
    for (int base = l.lo[up] & ~(D - 1); base <= l.hi[up]; base += D) {
        Coord lo = l.lo, hi = l.hi;
        lo[up] = std::max(lo[up], base);
        hi[up] = std::min(hi[up], base + D - 1);
        slab.resize(size_t(hi[up] - lo[up] + 1) * size_t(layer) * components);
        const ptrdiff_t first = ptrdiff_t(lo[up] - l.lo[up]) * layer;
        const Coord begin = lo & ~(D - 1);
        for (int oz = begin[2]; oz <= hi[2]; oz += D)
            for (int oy = begin[1]; oy <= hi[1]; oy += D)
                for (int ox = begin[0]; ox <= hi[0]; ox += D) {
                    const Coord o(ox, oy, oz);
                    const auto *leaf = at.probeConstLeaf(o);
                    const auto tile = leaf ? grid.background() : at.getValue(o);
                    const Coord b = Coord::maxComponent(o, lo),
                                e = Coord::minComponent(o.offsetBy(D - 1), hi);
                    for (int y = b[1]; y <= e[1]; y++)
                        for (int z = b[2]; z <= e[2]; z++)
                            for (int x = b[0]; x <= e[0]; x++)
                                store(slab.data() + size_t(l.at(x, y, z) - first) * components,
                                      leaf ? leaf->getValue(Coord(x, y, z)) : tile);
                }
        must(serve_add(answer, slab.data(), slab.size() * sizeof(float)));
    }
}

void send_grid(const openvdb::GridBase &base, const vdb::lattice &l, const std::string &name,
               vdb_part_grid *part, struct serve_answer *answer)
{
    const bool is_vector = base.isType<openvdb::Vec3SGrid>();
    if (!is_vector && !base.isType<openvdb::FloatGrid>())
        throw std::runtime_error("grid '" + name + "' does not hold floats");
    part->components = is_vector ? 3 : 1;
    part->kind = base.getGridClass() == openvdb::GRID_LEVEL_SET    ? GRID_LEVEL_SET
                 : base.getGridClass() == openvdb::GRID_FOG_VOLUME ? GRID_FOG
                                                                   : GRID_PLAIN;
    if (!answer)
        return;
    if (is_vector)
        send_dense(
            static_cast<const openvdb::Vec3SGrid &>(base), l, 3,
            [&](float *to, const Vec3f &v) {
                const Vec3f s = vdb::sim_from_file(v, l.y_up);
                to[0] = s[0], to[1] = s[1], to[2] = s[2];
            },
            answer);
    else
        send_dense(
            static_cast<const openvdb::FloatGrid &>(base), l, 1, [](float *to, float v) { *to = v; }, answer);
}

/* A lattice's size as a file gives it; of more voxels than memory holds it means nothing. */
void set_size(int32_t n[3], const openvdb::Vec3i &size)
{
    double voxels = 1;
    for (int a = 0; a < 3; a++) {
        n[a] = size[a];
        if (n[a] < 1 || n[a] > 1 << 20)
            throw std::runtime_error("its grids have no sensible size");
        voxels *= n[a];
    }
    if (voxels * sizeof(float) > double(memory_available()))
        throw std::runtime_error("its grids are larger than this machine's memory");
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
    size_t n() const
    {
        return begin.back();
    }
    template <class work_fn> void each(const work_fn &work) const
    {
        for (size_t i = 0; i < leaf.size(); i++)
            work(*leaf[i], begin[i]);
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

std::vector<float> positions(const point_leaves &leaves, const PointDataGrid &grid, bool y_up)
{
    std::vector<float> P(4 * leaves.n());
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
    return P;
}

void send_field(const point_leaves &leaves, enum rock_field f, bool y_up, struct serve_answer *answer)
{
    const rock_field_info &info = rock_field_table[f];
    if (info.components == 4) {
        std::vector<float> out(4 * leaves.n());
        read_attribute<Vec3f>(leaves, info.vdb, [&](size_t i, const Vec3f &v) {
            const Vec3f s = vdb::sim_from_file(v, y_up);
            out[4 * i] = s[0], out[4 * i + 1] = s[1], out[4 * i + 2] = s[2];
        });
        must(serve_put(answer, out.data(), out.size() * sizeof out[0]));
    } else if (info.is_float) {
        std::vector<float> out(leaves.n());
        read_attribute<float>(leaves, info.vdb, [&](size_t i, float v) { out[i] = v; });
        must(serve_put(answer, out.data(), out.size() * sizeof out[0]));
    } else {
        std::vector<uint32_t> out(leaves.n());
        read_attribute<int32_t>(leaves, info.vdb, [&](size_t i, int32_t v) { out[i] = uint32_t(v); });
        must(serve_put(answer, out.data(), out.size() * sizeof out[0]));
    }
}

/* What the frame's lattice is, and each grid's; with an answer their values too. */
vdb_part_volumes volumes_of(const vdb::file &file, const struct serve_question *q,
                            struct serve_answer *answer)
{
    vdb_part_volumes part{};
    const auto size = file.metadata->getMetadata<openvdb::Vec3IMetadata>(vdb::LATTICE);
    if (!size)
        throw std::runtime_error(
            "not a volume file of hoodoo: it does not say how many voxels its grids have");
    set_size(part.n, size->value());
    for (size_t k = 0; k < q->n_words; k++) {
        const auto base = file.grid(q->word[k]);
        if (!base)
            continue;
        if (part.n_grids == VDB_PART_GRIDS)
            throw std::runtime_error("it has more grids than a frame");
        vdb_part_grid &g = part.grid[part.n_grids++];
        const Vec3d origin = vdb::sim_from_file(base->transform().indexToWorld(Vec3d(0)), file.y_up);
        const auto own = base->getMetadata<openvdb::Vec3IMetadata>(vdb::LATTICE);
        g.word = uint32_t(k);
        (own ? g.own_voxel : part.voxel) = base->voxelSize()[0];
        for (int a = 0; a < 3; a++)
            (own ? g.own_origin : part.origin)[a] = origin[a];
        if (own)
            set_size(g.own_n, own->value());
        send_grid(*base, vdb::lattice(own ? g.own_n : part.n, file.y_up), q->word[k], &g, answer);
    }
    return part;
}
} // namespace

extern "C" status vdb_serve_volumes(const struct serve_question *q, struct serve_answer *answer)
try {
    vdb::file file;
    const status st = vdb::load(q->path, &file);
    if (st != OK)
        return st;
    const vdb_part_volumes part = volumes_of(file, q, nullptr);
    must(serve_put(answer, &part, sizeof part));
    volumes_of(file, q, answer);
    return OK;
} catch (const failure &) {
    return E_MEMORY;
}
SHIM_CATCH(E_INPUT, q->path)

extern "C" status vdb_serve_points(const struct serve_question *q, struct serve_answer *answer)
try {
    vdb::file file;
    const status st = vdb::load(q->path, &file);
    if (st != OK)
        return st;
    const auto named = file.grid("points");
    const auto grid = named ? openvdb::gridPtrCast<PointDataGrid>(named) : nullptr;
    if (!grid)
        throw std::runtime_error("it holds no points");
    const point_leaves leaves(*grid);
    vdb_part_points part{};
    part.n = leaves.n();
    for (int f = 0; f < ROCK_FIELDS; f++)
        part.has[f] =
            f == ROCK_P || (*rock_field_table[f].vdb &&
                            (leaves.leaf.empty() || leaves.leaf[0]->hasAttribute(rock_field_table[f].vdb)));
    must(serve_put(answer, &part, sizeof part));
    for (int f = 0; f < ROCK_FIELDS; f++)
        if (f == ROCK_P) {
            const std::vector<float> P = positions(leaves, *grid, file.y_up);
            must(serve_put(answer, P.data(), P.size() * sizeof P[0]));
        } else if (part.has[f]) {
            send_field(leaves, static_cast<enum rock_field>(f), file.y_up, answer);
        }
    return OK;
} catch (const failure &) {
    return E_MEMORY;
}
SHIM_CATCH(E_INPUT, q->path)
