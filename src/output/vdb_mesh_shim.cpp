/* The zero surface of a frame's level set as triangles, with values of the frame's other grids at its
 * vertices. */
#include "output/vdb_shim.hpp"

extern "C" {
#include "mesh/trimesh.h"
}

#include <openvdb/io/File.h>
#include <openvdb/tools/Interpolation.h>
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

/* No simplified edge is longer, in voxels: values vary along it. */
constexpr double LONGEST = 12;
/* Indices of voxels are less. */
constexpr double FARTHEST = 1 << 24;

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

/* A level set's samples around its surface, in the simulator's axes, with one more on every side. */
struct samples {
    trimesh_lattice lattice;
    std::vector<float> value;

    samples(const FloatGrid &grid, bool y_up)
    {
        const double voxel = grid.voxelSize()[0];
        if (!grid.hasUniformVoxels() || !(voxel > 0) || !std::isfinite(voxel))
            throw std::runtime_error("the voxels of 'surface' are not cubes");
        openvdb::CoordBBox box;
        if (!grid.tree().evalActiveVoxelBoundingBox(box))
            box = openvdb::CoordBBox(Coord(0), Coord(0));
        double n = 1;
        for (int d = 0; d < 3; d++) {
            if (std::abs(double(box.min()[d])) > FARTHEST || std::abs(double(box.max()[d])) > FARTHEST)
                throw std::runtime_error("'surface' has voxels too far from its origin");
            n *= box.max()[d] - box.min()[d] + 3;
        }
        if (n > double(memory_available()) / sizeof(float) / 2)
            throw std::runtime_error("'surface' is larger than this machine's memory");
        box.expand(1);
        const Coord a = vdb::sim_from_file(box.min(), y_up), b = vdb::sim_from_file(box.max(), y_up);
        const Coord lo = Coord::minComponent(a, b), hi = Coord::maxComponent(a, b);
        const Vec3d origin = vdb::sim_from_file(grid.indexToWorld(Vec3d(0)), y_up);
        lattice.voxel = voxel;
        for (int d = 0; d < 3; d++) {
            lattice.n[d] = hi[d] - lo[d] + 1;
            lattice.origin[d] = origin[d] + voxel * lo[d];
        }
        value.resize(size_t(n));
        const size_t rows = size_t(lattice.n[1]) * size_t(lattice.n[2]);
        tbb::parallel_for(tbb::blocked_range<size_t>(0, rows, 64), [&](const tbb::blocked_range<size_t> &r) {
            const FloatGrid::ConstAccessor at = grid.getConstAccessor();
            for (size_t row = r.begin(); row < r.end(); row++) {
                const Coord first =
                    lo.offsetBy(0, int(row % size_t(lattice.n[1])), int(row / size_t(lattice.n[1])));
                float *to = value.data() + row * size_t(lattice.n[0]);
                for (int x = 0; x < lattice.n[0]; x++)
                    to[x] = at.getValue(vdb::file_from_sim(first.offsetBy(x, 0, 0), y_up));
            }
        });
    }
};

/* Freed unless it is handed on. */
struct triangles {
    trimesh m{};
    ~triangles()
    {
        trimesh_free(&m);
    }
};

/* Labels, smooths, simplifies. */
status work_on(trimesh &m, const vdb_mesh_options &o, double voxel, vdb_mesh &out)
{
    status st = OK;
    if (o.label) {
        out.label = allocate<uint32_t>(m.n_vertices);
        st = o.label(o.user, reinterpret_cast<const float(*)[3]>(m.vertex), m.n_vertices, out.label);
    }
    if (st == OK && o.smooth > 0)
        st = trimesh_smooth(&m, out.label, o.smooth, VDB_MESH_SMOOTH_REACH * voxel);
    uint32_t *kept = nullptr;
    if (st == OK && o.adaptivity > 0)
        st = trimesh_simplify(&m, out.label, o.adaptivity * voxel, LONGEST * voxel, &kept);
    for (size_t i = 0; kept && st == OK && out.label && i < m.n_vertices; i++)
        out.label[i] = out.label[kept[i]];
    std::free(kept);
    return st;
}

void set_normals(const trimesh &m, const FloatGrid &surface, bool y_up, bool of_triangles, float *normal)
{
    if (of_triangles) {
        trimesh_normals(&m, normal);
        return;
    }
    for_each(m.n_vertices, [&](size_t begin, size_t end) {
        const FloatGrid::ConstAccessor at = surface.getConstAccessor();
        for (size_t i = begin; i < end; i++) {
            const Vec3d x = vdb::file_from_sim(Vec3d(Vec3s(m.vertex + 3 * i)), y_up);
            const Vec3d n = vdb::sim_from_file(gradient(at, surface.worldToIndex(x)), y_up);
            for (int a = 0; a < 3; a++)
                normal[3 * i + size_t(a)] = float(n[a]);
        }
    });
}
} // namespace

extern "C" status vdb_mesh_make(const char *path, const struct vdb_mesh_options *options,
                                struct vdb_mesh *out)
try {
    *out = vdb_mesh{};
    /* In a child process first: what gets through there is safe to read here. */
    status st = vdb_check(path);
    if (st != OK)
        return st;
    vdb::start();
    openvdb::io::File file(path);
    file.open(/*delayLoad=*/false);
    const bool y_up = vdb::is_y_up(*file.getMetadata());
    const FloatGrid::Ptr surface = read_float_grid(file, "surface");

    struct owner {
        vdb_mesh mesh{};
        ~owner()
        {
            vdb_mesh_free(&mesh);
        }
    } made;
    vdb_mesh &mesh = made.mesh;
    triangles t;
    double voxel;
    {
        samples s(*surface, y_up);
        voxel = s.lattice.voxel;
        st = trimesh_march(s.value.data(), &s.lattice, &t.m);
    }
    if (st == OK)
        st = work_on(t.m, *options, voxel, mesh);
    if (st != OK)
        return fail(st, "%s: %s", path, std::string(status_message()).c_str());
    mesh.n_vertices = t.m.n_vertices;
    mesh.n_triangles = t.m.n_triangles;
    mesh.normal = allocate<float>(3 * mesh.n_vertices);
    set_normals(t.m, *surface, y_up, options->smooth > 0, mesh.normal);
    if (options->n_values)
        mesh.value = allocate<float>(options->n_values * mesh.n_vertices);
    for (size_t k = 0; k < options->n_values; k++) {
        const char *name = options->values[k];
        if (k + options->n_optional >= options->n_values && !file.hasGrid(name))
            continue;
        const FloatGrid::Ptr grid = read_float_grid(file, name);
        for_each(mesh.n_vertices, [&](size_t begin, size_t end) {
            const FloatGrid::ConstAccessor at = grid->getConstAccessor();
            for (size_t i = begin; i < end; i++) {
                const Vec3d x = vdb::file_from_sim(Vec3d(Vec3s(t.m.vertex + 3 * i)), y_up);
                mesh.value[k * mesh.n_vertices + i] = value_at(at, grid->worldToIndex(x));
            }
        });
    }
    std::swap(mesh.vertex, t.m.vertex);
    std::swap(mesh.triangle, t.m.triangle);
    *out = mesh;
    mesh = vdb_mesh{};
    return OK;
}
SHIM_CATCH(E_INPUT, path)

extern "C" status vdb_mesh_read(const char *path, double adaptivity, const char *const *values,
                                size_t n_values, size_t n_optional, struct vdb_mesh *out)
{
    const vdb_mesh_options options = {adaptivity, 0, values, n_values, n_optional, nullptr, nullptr};
    return vdb_mesh_make(path, &options, out);
}

extern "C" void vdb_mesh_free(struct vdb_mesh *mesh)
{
    std::free(mesh->vertex);
    std::free(mesh->normal);
    std::free(mesh->triangle);
    std::free(mesh->value);
    std::free(mesh->label);
    *mesh = vdb_mesh{};
}
