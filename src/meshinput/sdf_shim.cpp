#include "meshinput/sdf_make.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <stdexcept>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/task_arena.h>

struct vdb_sdf {
    openvdb::FloatGrid::Ptr grid;
    struct sdf_gap gap;
    openvdb::MaskGrid::Ptr across; /* voxels next to the middle of a gap */
};

namespace
{
using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::Vec3d;
using leaf_node = openvdb::FloatTree::LeafNodeType;

/* The voxel at the centre of the vertices' bounding box. */
Coord centre_voxel(const struct sdf_request &q)
{
    openvdb::BBoxd box;
    for (size_t i = 0; i < q.n_vertices; i++)
        box.expand(Vec3d(q.vertex[i]));
    return q.n_vertices ? Coord::round(box.getCenter() / q.voxel) : Coord();
}

/* Unsigned distances. */
FloatGrid::Ptr distances(const struct sdf_request &q)
{
    /* The library's precompiled code takes floats. Relative to the mesh's own centre, rounded to whole voxels, they are as exact as
     * doubles. */
    const Coord middle = centre_voxel(q);
    std::vector<openvdb::Vec3s> point(q.n_vertices);
    for (size_t i = 0; i < q.n_vertices; i++)
        for (int a = 0; a < 3; a++)
            point[i][a] = float(q.vertex[i][a] / q.voxel - middle[a]);
    std::vector<openvdb::Vec3I> corners(q.n_triangles);
    for (size_t t = 0; t < q.n_triangles; t++)
        corners[t] = openvdb::Vec3I(q.triangle[t]);
    const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> mesh(point, corners);
    openvdb::math::Transform::Ptr transform = openvdb::math::Transform::createLinearTransform(q.voxel);
    transform->postTranslate(middle.asVec3d() * q.voxel);
    const float voxels = float(q.band / q.voxel);
    openvdb::util::NullInterrupter never;
    return openvdb::tools::meshToVolume<FloatGrid>(never, mesh, *transform, voxels, voxels,
                                                   openvdb::tools::UNSIGNED_DISTANCE_FIELD,
                                                   static_cast<openvdb::Int32Grid *>(nullptr));
}

constexpr size_t LEAF = leaf_node::SIZE;
constexpr uint32_t NO_LEAF = UINT32_MAX, NO_PART = UINT32_MAX;

/* The grid's voxels, numbered leaf by leaf, and their neighbours. */
struct voxels {
    std::vector<leaf_node *> leaf;
    std::vector<std::array<uint32_t, 6>> beside; /* by leaf: its neighbours at -x, +x, -y, +y, -z, +z */

    explicit voxels(openvdb::FloatTree &tree)
    {
        tree.voxelizeActiveTiles(false);
        tree.getNodes(leaf);
        if (leaf.size() >= UINT32_MAX / LEAF)
            throw std::runtime_error("the grid has more than 2^32 voxels");
        std::unordered_map<Coord, uint32_t, hash> number;
        for (size_t i = 0; i < leaf.size(); i++)
            number[leaf[i]->origin()] = uint32_t(i);
        beside.resize(leaf.size());
        for (size_t i = 0; i < leaf.size(); i++)
            for (int side = 0; side < 6; side++) {
                Coord at = leaf[i]->origin();
                at[side / 2] += side % 2 ? int(leaf_node::DIM) : -int(leaf_node::DIM);
                const auto found = number.find(at);
                beside[i][size_t(side)] = found == number.end() ? NO_LEAF : found->second;
            }
    }

    struct hash {
        size_t operator()(const Coord &c) const
        {
            return c.hash<20>();
        }
    };

    bool is_active(uint32_t v) const
    {
        return leaf[v / LEAF]->isValueOn(v % LEAF);
    }
    float value(uint32_t v) const
    {
        return leaf[v / LEAF]->getValue(v % LEAF);
    }
    Coord place(uint32_t v) const
    {
        return leaf[v / LEAF]->offsetToGlobalCoord(v % LEAF);
    }

    /* The active neighbour of v, or NO_PART. */
    uint32_t next(uint32_t v, int side) const
    {
        static const uint32_t step[3] = {LEAF / leaf_node::DIM, leaf_node::DIM, 1};
        const uint32_t s = step[side / 2], along = v / s % leaf_node::DIM;
        uint32_t to;
        if (side % 2 ? along + 1 < leaf_node::DIM : along > 0) {
            to = side % 2 ? v + s : v - s;
        } else {
            const uint32_t l = beside[v / LEAF][size_t(side)];
            if (l == NO_LEAF)
                return NO_PART;
            to = uint32_t(l * LEAF + v % LEAF);
            to = side % 2 ? to - s * (leaf_node::DIM - 1) : to + s * (leaf_node::DIM - 1);
        }
        return is_active(to) ? to : NO_PART;
    }
};

/* Is there surely no triangle between two neighbouring voxels with these distances? Distances up to 0.86 voxels are exact, longer ones
 * may be overestimated. If the farther voxel were within 0.86, its distance would be exact and not more than a voxel; so it is farther,
 * and a triangle between the two would be within 0.14 voxels of the nearer one. */
bool are_connected(float a, float b, float voxel)
{
    return std::max(a, b) > 1.001f * voxel && std::min(a, b) > 0.25f * voxel;
}

/* The coarse cells around open edges, where a voxel may be on another side of the surface than its neighbours without a triangle
 * between them. */
struct open_cells {
    double side;
    bool everywhere = false;
    std::unordered_set<Coord, voxels::hash> cell;

    open_cells(const struct sdf_request &q) : side(q.hole)
    {
        constexpr double MANY = 1e6; /* with more cells than this, every voxel counts as close */
        for (size_t i = 0; i < q.n_open && !everywhere; i++) {
            openvdb::BBoxd box;
            box.expand(Vec3d(q.vertex[q.open[i][0]]));
            box.expand(Vec3d(q.vertex[q.open[i][1]]));
            const Vec3d a = box.min() / side - Vec3d(1), b = box.max() / side + Vec3d(1);
            const Vec3d n = b - a + Vec3d(1);
            everywhere = !(n[0] * n[1] * n[2] + double(cell.size()) < MANY);
            if (everywhere)
                break;
            const openvdb::CoordBBox cells(Coord::floor(a), Coord::floor(b));
            for (auto c = cells.begin(); c; ++c)
                cell.insert(*c);
        }
    }
    bool is_close(const Vec3d &x) const
    {
        return everywhere || (!cell.empty() && cell.count(Coord::floor(x / side)) > 0);
    }
};

/* Splits the voxels into connected parts that no triangle crosses, and takes the winding number of one voxel for the whole part. */
struct signs {
    const struct sdf_request &q;
    const voxels &all;
    const openvdb::math::Transform &transform;
    const open_cells open;
    std::vector<uint32_t> part;   /* by voxel */
    std::vector<uint32_t> sample; /* by part: its voxel farthest from the surface */
    std::vector<bool> inside;     /* by part */

    signs(const struct sdf_request &question, const voxels &v, const openvdb::math::Transform &t)
        : q(question), all(v), transform(t), open(question), part(v.leaf.size() * LEAF, NO_PART)
    {
        std::vector<uint32_t> todo;
        for (uint32_t v = 0; v < part.size(); v++)
            if (part[v] == NO_PART && all.is_active(v))
                grow(v, todo);
        find_inside();
    }

    Vec3d at(uint32_t v) const
    {
        return transform.indexToWorld(all.place(v));
    }

    void grow(uint32_t first, std::vector<uint32_t> &todo)
    {
        const uint32_t number = uint32_t(sample.size());
        part[first] = number;
        sample.push_back(first);
        if (open.is_close(at(first)))
            return;
        todo.assign(1, first);
        while (!todo.empty()) {
            const uint32_t v = todo.back();
            todo.pop_back();
            const float d = all.value(v);
            if (d > all.value(sample[number]))
                sample[number] = v;
            for (int side = 0; side < 6; side++) {
                const uint32_t to = all.next(v, side);
                if (to == NO_PART || part[to] != NO_PART ||
                    !are_connected(d, all.value(to), float(q.voxel)) || open.is_close(at(to)))
                    continue;
                part[to] = number;
                todo.push_back(to);
            }
        }
    }

    void find_inside()
    {
        constexpr size_t BATCH = 1 << 16;
        std::vector<double> x(3 * BATCH);
        std::vector<float> number(BATCH);
        inside.resize(sample.size());
        for (size_t first = 0; first < sample.size(); first += BATCH) {
            const size_t n = std::min(BATCH, sample.size() - first);
            for (size_t i = 0; i < n; i++) {
                const Vec3d place = at(sample[first + i]);
                std::memcpy(&x[3 * i], place.asPointer(), 3 * sizeof(double));
            }
            q.winding(q.context, reinterpret_cast<const double(*)[3]>(x.data()), n, number.data());
            for (size_t i = 0; i < n; i++)
                inside[first + i] = std::fabs(number[i]) >= 0.5f;
        }
    }

    bool is_inside(uint32_t v) const
    {
        return inside[part[v]];
    }
};

/* Makes the distances inside negative. */
void apply(const signs &s, voxels &all)
{
    for (uint32_t v = 0; v < s.part.size(); v++)
        if (s.part[v] != NO_PART && s.is_inside(v))
            all.leaf[v / LEAF]->setValueOnly(v % LEAF, -all.value(v));
}

/* Half the width of the gap between two neighbouring voxels, or 0: their signs differ, but no triangle is between them. */
float half_gap(float a, float b, float voxel)
{
    const bool across = (a < 0) != (b < 0) && are_connected(std::fabs(a), std::fabs(b), voxel);
    return across ? std::max(std::fabs(a), std::fabs(b)) : 0;
}

struct sdf_gap close_gaps(voxels &all, const FloatGrid &grid, float voxel, openvdb::MaskTree &beside)
{
    struct sdf_gap gap = {};
    std::vector<uint32_t> across;
    for (uint32_t v = 0; v < all.leaf.size() * LEAF; v++)
        for (int side = 0; side < 6 && all.is_active(v); side++) {
            const uint32_t to = all.next(v, side);
            const float half = to == NO_PART ? 0 : half_gap(all.value(v), all.value(to), voxel);
            if (half == 0)
                continue;
            across.push_back(v);
            if (2.0 * double(half) > gap.width) {
                const Vec3d x = grid.indexToWorld(all.place(v));
                gap.width = 2.0 * double(half);
                std::memcpy(gap.at, x.asPointer(), sizeof gap.at);
            }
        }
    for (const uint32_t v : across) {
        beside.setValueOn(all.place(v));
        const float near = std::copysign(voxel / 2, all.value(v));
        if (std::fabs(all.value(v)) > voxel / 2)
            all.leaf[v / LEAF]->setValueOnly(v % LEAF, near);
    }
    return gap;
}

/* Runs `work` in a single thread: where two triangles are equally close, the result must not depend on timing. */
template <class work_fn> void in_one_thread(const work_fn &work)
{
    tbb::task_arena arena(1);
    arena.execute(work);
}
} // namespace

extern "C" status sdf_make(const struct sdf_request *q, struct vdb_sdf **out)
{
    try {
        auto sdf = std::make_unique<vdb_sdf>();
        in_one_thread([&] { sdf->grid = distances(*q); });
        voxels all(sdf->grid->tree());
        apply(signs(*q, all, sdf->grid->transform()), all);
        sdf->across = openvdb::MaskGrid::create();
        sdf->gap = close_gaps(all, *sdf->grid, float(q->voxel), sdf->across->tree());
        in_one_thread([&] {
            openvdb::tools::signedFloodFillWithValues(sdf->grid->tree(), float(q->band), -float(q->band));
        });
        sdf->grid->setGridClass(openvdb::GRID_LEVEL_SET);
        *out = sdf.release();
        return OK;
    } catch (const std::bad_alloc &) {
        return fail(E_MEMORY, "out of memory: voxelising a mesh of %zu triangles at %g m", q->n_triangles,
                    q->voxel);
    } catch (const std::exception &e) {
        return fail(E_INPUT, "a mesh of %zu triangles cannot be voxelised at %g m: %s", q->n_triangles,
                    q->voxel, e.what());
    } catch (...) {
        return fail(E_INPUT, "a mesh of %zu triangles cannot be voxelised at %g m", q->n_triangles, q->voxel);
    }
}

extern "C" status sdf_from_samples(const struct sdf_samples *s, struct vdb_sdf **out)
{
    constexpr float BAND = 2.25f; /* voxels */
    try {
        auto sdf = std::make_unique<vdb_sdf>();
        openvdb::math::Mat4d affine = openvdb::math::Mat4d::identity(); /* for row vectors */
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 4; c++)
                affine[c][r] = s->world_from_index[r][c];
        sdf->grid = FloatGrid::create(BAND * float(s->voxel));
        sdf->grid->setTransform(openvdb::math::Transform::createLinearTransform(affine));
        FloatGrid::Accessor at = sdf->grid->getAccessor();
        for (size_t i = 0; i < s->n; i++)
            at.setValueOn(Coord(s->at[i][0], s->at[i][1], s->at[i][2]), s->value[i] * float(s->voxel));
        in_one_thread([&] {
            openvdb::tools::signedFloodFillWithValues(sdf->grid->tree(), BAND * float(s->voxel),
                                                      -BAND * float(s->voxel));
        });
        *out = sdf.release();
        return OK;
    } catch (const std::bad_alloc &) {
        return fail(E_MEMORY, "out of memory: a solid of %zu samples", s->n);
    } catch (const std::exception &e) {
        return fail(E_INPUT, "a solid of %zu samples cannot be made: %s", s->n, e.what());
    } catch (...) {
        return fail(E_INPUT, "a solid of %zu samples cannot be made", s->n);
    }
}

extern "C" void sdf_destroy(struct vdb_sdf **sdf)
{
    delete *sdf;
    *sdf = nullptr;
}

extern "C" double sdf_at(const struct vdb_sdf *sdf, const double x[3])
{
    /* An unregistered accessor costs nothing to make and caches the leaf for the other seven corners. */
    openvdb::FloatGrid::ConstUnsafeAccessor accessor(sdf->grid->constTree());
    const openvdb::Vec3d index = sdf->grid->transform().worldToIndex(openvdb::Vec3d(x[0], x[1], x[2]));
    return double(openvdb::tools::BoxSampler::sample(accessor, index));
}

extern "C" struct sdf_gap sdf_gap(const struct vdb_sdf *sdf)
{
    return sdf->gap;
}

extern "C" status sdf_caps(const struct vdb_sdf *sdf, struct sdf_caps *out)
{
    try {
        std::vector<openvdb::Vec3s> point;
        std::vector<openvdb::Vec3I> triangle;
        std::vector<openvdb::Vec4I> quad;
        in_one_thread([&] { openvdb::tools::volumeToMesh(*sdf->grid, point, triangle, quad, 0, 0); });
        for (const openvdb::Vec4I &f : quad) {
            triangle.emplace_back(f[0], f[1], f[2]);
            triangle.emplace_back(f[0], f[2], f[3]);
        }
        const auto is_elsewhere = [&](const openvdb::Vec3I &t) {
            const Vec3d middle = (Vec3d(point[t[0]]) + Vec3d(point[t[1]]) + Vec3d(point[t[2]])) / 3;
            const Coord cell = Coord::floor(sdf->grid->worldToIndex(middle));
            for (int c = 0; c < 8; c++)
                if (sdf->across->tree().isValueOn(cell.offsetBy(c & 1, c >> 1 & 1, c >> 2)))
                    return false;
            return true;
        };
        triangle.erase(std::remove_if(triangle.begin(), triangle.end(), is_elsewhere), triangle.end());
        out->n_vertices = point.size();
        out->n_triangles = triangle.size();
        out->vertex = static_cast<double(*)[3]>(std::malloc((point.size() + 1) * sizeof *out->vertex));
        out->triangle =
            static_cast<uint32_t(*)[3]>(std::malloc((out->n_triangles + 1) * sizeof *out->triangle));
        if (!out->vertex || !out->triangle)
            throw std::bad_alloc();
        for (size_t i = 0; i < point.size(); i++)
            for (int a = 0; a < 3; a++)
                out->vertex[i][a] = double(point[i][a]);
        for (size_t i = 0; i < triangle.size(); i++)
            for (int k = 0; k < 3; k++)
                out->triangle[i][k] = triangle[i][k];
        return OK;
    } catch (...) {
        std::free(out->vertex);
        std::free(out->triangle);
        *out = {};
        return fail(E_MEMORY, "out of memory: closing the holes of a mesh");
    }
}
