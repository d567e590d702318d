/* Reads frames back from their files: volumes as bricks of samples, points as particles. Runs in hoodoo-read. */
#include "vdb/shim.hpp"

#include <openvdb/points/AttributeArray.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

extern "C" {
#include "vdb/serve.h"
}

namespace
{
using openvdb::Coord;
using openvdb::Vec3d;
using openvdb::Vec3f;
using openvdb::points::PointDataGrid;

/* Thrown when the answer cannot be written; the message is set. */
struct failure : std::exception {
};
void must(status st)
{
    if (st != OK)
        throw failure();
}

/* Samples that are buffered on the way to the answer. A grid may be much larger than its file. */
constexpr size_t TOGETHER = 1 << 16;

/* A buffer of samples for the answer. */
struct stream {
    struct serve_answer *answer;
    std::vector<float> sample;

    explicit stream(struct serve_answer *a) : answer(a)
    {
        must(serve_begin_part(answer));
    }
    void put(float v)
    {
        sample.push_back(v);
        if (sample.size() >= TOGETHER)
            flush();
    }
    void put(const Vec3f &v)
    {
        for (int a = 0; a < 3; a++)
            put(v[a]);
    }
    void flush()
    {
        must(serve_append(answer, sample.data(), sample.size() * sizeof(float)));
        sample.clear();
    }
};

Vec3f in_sim(const Vec3f &v, bool y_up)
{
    return vdb::sim_from_file(v, y_up);
}
float in_sim(float v, bool)
{
    return v;
}

/* Sample (x, y, z) of a lattice, in the simulator's axes. */
template <class accessor> auto sample_at(const accessor &at, int x, int y, int z, bool y_up)
{
    return in_sim(at.getValue(vdb::file_from_sim(Coord(x, y, z), y_up)), y_up);
}

/* The bricks of the frame's lattice (particles/grids.h) in which any of its grids has content. */
struct bricks {
    int n[3], m[3];
    bool y_up;
    std::vector<bool> held;
    std::vector<uint32_t> number;

    bricks(const int32_t size[3], bool y) : y_up(y)
    {
        for (int a = 0; a < 3; a++)
            n[a] = size[a];
        held.resize(grid_bricks_of(n, m));
    }

    /* Adds all bricks that overlap this box of the file's index space. */
    void hold(const openvdb::CoordBBox &box)
    {
        const Coord a = vdb::sim_from_file(box.min(), y_up), b = vdb::sim_from_file(box.max(), y_up);
        int lo[3], hi[3];
        for (int d = 0; d < 3; d++) {
            lo[d] = std::max(std::min(a[d], b[d]), 0) / BRICK_SIDE;
            hi[d] = std::min(std::max(a[d], b[d]), n[d] - 1);
            if (hi[d] < 0)
                return;
            hi[d] /= BRICK_SIDE;
        }
        for (int z = lo[2]; z <= hi[2]; z++)
            for (int y = lo[1]; y <= hi[1]; y++)
                for (int x = lo[0]; x <= hi[0]; x++)
                    held[(size_t(z) * size_t(m[1]) + size_t(y)) * size_t(m[0]) + size_t(x)] = true;
    }

    /* Adds the bricks where tiles or voxels of leaves differ from the grid's background. */
    template <class grid_type> void hold_grid(const grid_type &grid)
    {
        const auto background = grid.background();
        auto tile = grid.tree().cbeginValueAll();
        for (tile.setMaxDepth(tile.getLeafDepth() - 1); tile; ++tile)
            if (*tile != background)
                hold(tile.getBoundingBox());
        for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf)
            for (auto v = leaf->cbeginValueAll(); v; ++v)
                if (*v != background)
                    hold(openvdb::CoordBBox(v.getCoord(), v.getCoord()));
    }

    void list()
    {
        for (size_t i = 0; i < held.size(); i++)
            if (held[i])
                number.push_back(uint32_t(i));
    }
};

template <class grid_type>
void send_bricks(const grid_type &grid, const bricks &b, struct serve_answer *answer)
{
    const auto at = grid.getConstAccessor();
    stream out(answer);
    for (const uint32_t number : b.number) {
        const int first[3] = {int(number % uint32_t(b.m[0])) * BRICK_SIDE,
                              int(number / uint32_t(b.m[0]) % uint32_t(b.m[1])) * BRICK_SIDE,
                              int(number / uint32_t(b.m[0]) / uint32_t(b.m[1])) * BRICK_SIDE};
        for (int z = first[2]; z < first[2] + BRICK_SIDE; z++)
            for (int y = first[1]; y < first[1] + BRICK_SIDE; y++)
                for (int x = first[0]; x < first[0] + BRICK_SIDE; x++)
                    out.put(x < b.n[0] && y < b.n[1] && z < b.n[2] ? sample_at(at, x, y, z, b.y_up)
                                                                   : in_sim(grid.background(), b.y_up));
    }
    out.flush();
}

/* Sets the size of the lattice from the file, and refuses one that does not fit into memory. */
void set_size(int32_t n[3], const openvdb::Vec3i &size)
{
    double bricks = 1;
    for (int a = 0; a < 3; a++) {
        n[a] = size[a];
        if (n[a] < 1 || n[a] > 1 << 20)
            throw std::runtime_error("the size of its grids is out of range");
        bricks *= (n[a] + BRICK_SIDE - 1) / BRICK_SIDE;
    }
    if (bricks > INT32_MAX || bricks * sizeof(float) > double(memory_available()))
        throw std::runtime_error("its grids are larger than this machine's memory");
}

/* A particle file being read: the leaves of its grids of points, and where each leaf's particles start. */
struct point_leaves {
    struct source {
        const openvdb::points::PointDataTree::LeafNodeType *leaf;
        const openvdb::math::Transform *transform;
    };
    std::vector<source> leaf;
    std::vector<size_t> begin{0};

    void add(const PointDataGrid &grid)
    {
        for (auto l = grid.tree().cbeginLeaf(); l; ++l) {
            l->validateOffsets();
            leaf.push_back({&*l, &grid.transform()});
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
            work(*leaf[i].leaf, begin[i], *leaf[i].transform);
    }
};

template <class T, class store_fn>
void read_attribute(const point_leaves &leaves, const std::string &name, const store_fn &store)
{
    leaves.each([&](const auto &leaf, size_t begin, const auto &) {
        const openvdb::points::AttributeHandle<T> handle(leaf.constAttributeArray(name));
        for (openvdb::Index i = 0; i < leaf.getLastValue(); i++)
            store(begin + i, handle.get(i));
    });
}

std::vector<float> positions(const point_leaves &leaves, bool y_up)
{
    std::vector<float> P(4 * leaves.n());
    leaves.each([&](const auto &leaf, size_t begin, const auto &transform) {
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
        must(serve_add_part(answer, out.data(), out.size() * sizeof out[0]));
    } else if (info.is_float) {
        std::vector<float> out(leaves.n());
        read_attribute<float>(leaves, info.vdb, [&](size_t i, float v) { out[i] = v; });
        must(serve_add_part(answer, out.data(), out.size() * sizeof out[0]));
    } else {
        std::vector<uint32_t> out(leaves.n());
        read_attribute<int32_t>(leaves, info.vdb, [&](size_t i, int32_t v) { out[i] = uint32_t(v); });
        must(serve_add_part(answer, out.data(), out.size() * sizeof out[0]));
    }
}

/* Calls work(grid) with the grid as its actual type. */
template <class work_fn>
void as_what_it_is(const openvdb::GridBase &base, const std::string &name, const work_fn &work)
{
    if (base.isType<openvdb::Vec3SGrid>())
        work(static_cast<const openvdb::Vec3SGrid &>(base));
    else if (base.isType<openvdb::FloatGrid>())
        work(static_cast<const openvdb::FloatGrid &>(base));
    else
        throw std::runtime_error("grid '" + name + "' does not hold floats");
}

/* Describes the frame's lattice and grids. */
vdb_part_volumes volumes_of(const vdb::file &file, const struct serve_question *q)
{
    vdb_part_volumes part{};
    const auto size = file.metadata->getMetadata<openvdb::Vec3IMetadata>(vdb::LATTICE);
    if (!size)
        throw std::runtime_error(
            "not a volume file of hoodoo: it does not say how many voxels its grids have");
    set_size(part.n, size->value());
    for (size_t k = 0; k < q->n_arguments; k++) {
        const auto base = file.grid(q->argument[k]);
        if (!base)
            continue;
        if (part.n_grids == VDB_PART_GRIDS)
            throw std::runtime_error("it has more grids than a frame");
        vdb_part_grid &g = part.grid[part.n_grids++];
        const Vec3d origin = vdb::sim_from_file(base->transform().indexToWorld(Vec3d(0)), file.y_up);
        g.word = uint32_t(k);
        g.components = base->isType<openvdb::Vec3SGrid>() ? 3 : 1;
        g.kind = base->getGridClass() == openvdb::GRID_LEVEL_SET    ? GRID_LEVEL_SET
                 : base->getGridClass() == openvdb::GRID_FOG_VOLUME ? GRID_FOG
                                                                    : GRID_PLAIN;
        part.voxel = base->voxelSize()[0];
        for (int a = 0; a < 3; a++)
            part.origin[a] = origin[a];
    }
    return part;
}

void send_volumes(const vdb::file &file, const struct serve_question *q, struct serve_answer *answer)
{
    vdb_part_volumes part = volumes_of(file, q);
    bricks held(part.n, file.y_up);
    const auto each = [&](const auto &work) {
        for (uint32_t i = 0; i < part.n_grids; i++) {
            const std::string name = q->argument[part.grid[i].word];
            as_what_it_is(*file.grid(name), name, work);
        }
    };
    each([&](const auto &grid) { held.hold_grid(grid); });
    held.list();
    part.n_bricks = held.number.size();
    must(serve_add_part(answer, &part, sizeof part));
    must(serve_add_part(answer, held.number.data(), held.number.size() * sizeof held.number[0]));
    each([&](const auto &grid) { send_bricks(grid, held, answer); });
}
} // namespace

extern "C" status vdb_serve_volumes(const struct serve_question *q, struct serve_answer *answer)
try {
    vdb::file file;
    const status st = vdb::load(q->path, &file);
    if (st != OK)
        return st;
    send_volumes(file, q, answer);
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
    point_leaves leaves;
    std::vector<PointDataGrid::Ptr> grids; /* points, points_2 and so on */
    for (std::string name = "points"; const auto named = file.grid(name.c_str());) {
        const auto grid = openvdb::gridPtrCast<PointDataGrid>(named);
        if (!grid)
            break;
        grids.push_back(grid);
        leaves.add(*grid);
        name = "points_" + std::to_string(grids.size() + 1);
    }
    if (grids.empty())
        throw std::runtime_error("it holds no points");
    vdb_part_points part{};
    part.n = leaves.n();
    for (int f = 0; f < ROCK_FIELDS; f++)
        part.has[f] = f == ROCK_P ||
                      (*rock_field_table[f].vdb &&
                       (leaves.leaf.empty() || leaves.leaf[0].leaf->hasAttribute(rock_field_table[f].vdb)));
    must(serve_add_part(answer, &part, sizeof part));
    for (int f = 0; f < ROCK_FIELDS; f++)
        if (f == ROCK_P) {
            const std::vector<float> P = positions(leaves, file.y_up);
            must(serve_add_part(answer, P.data(), P.size() * sizeof P[0]));
        } else if (part.has[f]) {
            send_field(leaves, static_cast<enum rock_field>(f), file.y_up, answer);
        }
    return OK;
} catch (const failure &) {
    return E_MEMORY;
}
SHIM_CATCH(E_INPUT, q->path)
