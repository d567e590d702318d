/* The zero surface of a frame's level set as triangles, with values of the frame's other grids at its
 * vertices. */
#include "output/vdb_shim.hpp"

#include <openvdb/io/File.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace
{
using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::Vec3d;
using openvdb::Vec3s;

FloatGrid::Ptr read_float_grid(openvdb::io::File &file, const std::string &name)
{
    if (!file.hasGrid(name))
        throw std::runtime_error("it has no grid '" + name + "'");
    auto grid = openvdb::gridPtrCast<FloatGrid>(file.readGrid(name));
    if (!grid)
        throw std::runtime_error("grid '" + name + "' does not hold floats");
    return grid;
}

/* The gradient over one voxel, at an index-space position. Unit length, or 0 where the field is flat. */
Vec3d gradient(const FloatGrid::ConstAccessor &at, const Vec3d &x)
{
    Vec3d g;
    for (int a = 0; a < 3; a++) {
        Vec3d step(0);
        step[a] = 0.5;
        g[a] = double(openvdb::tools::BoxSampler::sample(at, x + step)) -
               double(openvdb::tools::BoxSampler::sample(at, x - step));
    }
    const double length = g.length();
    return length > 0 ? g / length : Vec3d(0);
}

/* Trilinear over active samples only, weights made to add up to 1: the empty side of a surface does not
 * dilute the value. Where no corner is active, the mean of the active voxels around them; 0 if there are
 * none. */
float value_at(const FloatGrid::ConstAccessor &at, const Vec3d &x)
{
    const Coord lo = Coord::floor(x);
    const double t[3] = {x[0] - lo[0], x[1] - lo[1], x[2] - lo[2]};
    double sum = 0, weight = 0;
    float v;
    for (int c = 0; c < 8; c++) {
        const int d[3] = {c & 1, c >> 1 & 1, c >> 2};
        double w = 1;
        for (int a = 0; a < 3; a++)
            w *= d[a] ? t[a] : 1 - t[a];
        if (w > 1e-9 && at.probeValue(lo.offsetBy(d[0], d[1], d[2]), v)) {
            sum += w * double(v);
            weight += w;
        }
    }
    if (weight == 0)
        for (int c = 0; c < 64; c++)
            if (at.probeValue(lo.offsetBy((c & 3) - 1, (c >> 2 & 3) - 1, (c >> 4) - 1), v)) {
                sum += double(v);
                weight += 1;
            }
    return weight > 0 ? float(sum / weight) : 0;
}

/* Calls work(i) for every i < n. */
template <class work_fn> void for_each(size_t n, const work_fn &work)
{
    tbb::parallel_for(tbb::blocked_range<size_t>(0, n, 1024),
                      [&](const tbb::blocked_range<size_t> &range) { work(range.begin(), range.end()); });
}

template <class T> T *allocate(size_t n)
{
    T *p = static_cast<T *>(std::calloc(n ? n : 1, sizeof(T)));
    if (!p)
        throw std::bad_alloc();
    return p;
}

/* Quads are cut along the shorter diagonal. OpenVDB winds clockwise seen from outside; here it is
 * counter-clockwise. */
void set_triangles(vdb_mesh &mesh, const std::vector<Vec3s> &points,
                   const std::vector<openvdb::Vec3I> &triangles, const std::vector<openvdb::Vec4I> &quads)
{
    mesh.n_triangles = triangles.size() + 2 * quads.size();
    mesh.triangle = allocate<uint32_t>(3 * mesh.n_triangles);
    uint32_t *t = mesh.triangle;
    const auto add = [&t](uint32_t a, uint32_t b, uint32_t c) {
        t[0] = a, t[1] = c, t[2] = b;
        t += 3;
    };
    for (const openvdb::Vec3I &p : triangles)
        add(p[0], p[1], p[2]);
    for (const openvdb::Vec4I &q : quads) {
        if ((points[q[0]] - points[q[2]]).lengthSqr() <= (points[q[1]] - points[q[3]]).lengthSqr()) {
            add(q[0], q[1], q[2]);
            add(q[0], q[2], q[3]);
        } else {
            add(q[1], q[2], q[3]);
            add(q[1], q[3], q[0]);
        }
    }
}
} // namespace

extern "C" status vdb_mesh_read(const char *path, double adaptivity, const char *const *values,
                                size_t n_values, size_t n_optional, struct vdb_mesh *out)
try {
    *out = vdb_mesh{};
    /* In a child process first: what gets through there is safe to read here. */
    const status st = vdb_check(path);
    if (st != OK)
        return st;
    vdb::start();
    openvdb::io::File file(path);
    file.open(/*delayLoad=*/false);
    const bool y_up = vdb::is_y_up(*file.getMetadata());
    const FloatGrid::Ptr surface = read_float_grid(file, "surface");
    const double voxel = surface->voxelSize()[0];
    if (!surface->hasUniformVoxels() || !(voxel > 0) || !std::isfinite(voxel))
        throw std::runtime_error("the voxels of 'surface' are not cubes");

    std::vector<Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(*surface, points, triangles, quads, 0.0, adaptivity);

    struct owner {
        vdb_mesh mesh{};
        ~owner()
        {
            vdb_mesh_free(&mesh);
        }
    } made;
    vdb_mesh &mesh = made.mesh;
    if (points.size() > UINT32_MAX)
        throw std::runtime_error("more than 2^32 vertices");
    set_triangles(mesh, points, triangles, quads);
    mesh.n_vertices = points.size();
    mesh.vertex = allocate<float>(3 * mesh.n_vertices);
    mesh.normal = allocate<float>(3 * mesh.n_vertices);
    for_each(points.size(), [&](size_t begin, size_t end) {
        const FloatGrid::ConstAccessor at = surface->getConstAccessor();
        for (size_t i = begin; i < end; i++) {
            const Vec3s x = vdb::sim_from_file(points[i], y_up);
            const Vec3d n = vdb::sim_from_file(gradient(at, surface->worldToIndex(Vec3d(points[i]))), y_up);
            for (int a = 0; a < 3; a++) {
                mesh.vertex[3 * i + size_t(a)] = x[a];
                mesh.normal[3 * i + size_t(a)] = float(n[a]);
            }
        }
    });
    if (n_values)
        mesh.value = allocate<float>(n_values * mesh.n_vertices);
    for (size_t k = 0; k < n_values; k++) {
        if (k + n_optional >= n_values && !file.hasGrid(values[k]))
            continue;
        const FloatGrid::Ptr grid = read_float_grid(file, values[k]);
        for_each(points.size(), [&](size_t begin, size_t end) {
            const FloatGrid::ConstAccessor at = grid->getConstAccessor();
            for (size_t i = begin; i < end; i++)
                mesh.value[k * mesh.n_vertices + i] = value_at(at, grid->worldToIndex(Vec3d(points[i])));
        });
    }
    *out = mesh;
    mesh = vdb_mesh{};
    return OK;
}
SHIM_CATCH(E_INPUT, path)

extern "C" void vdb_mesh_free(struct vdb_mesh *mesh)
{
    std::free(mesh->vertex);
    std::free(mesh->normal);
    std::free(mesh->triangle);
    std::free(mesh->value);
    *mesh = vdb_mesh{};
}
