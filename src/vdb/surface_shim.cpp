/* Samples of a frame's level set, and the values of its grids at given positions. Runs in hoodoo-read. */
#include "vdb/shim.hpp"

extern "C" {
#include "mesh/trimesh.h"
#include "vdb/serve.h"
}

#include <openvdb/tools/Interpolation.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <vector>

namespace
{
using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::Vec3d;
using openvdb::Vec3s;

/* Indices of voxels must be below this. */
constexpr double FARTHEST = 1 << 24;

FloatGrid::Ptr float_grid(const vdb::file &file, const std::string &name)
{
    const auto named = file.grid(name);
    if (!named)
        throw std::runtime_error("it has no grid '" + name + "'");
    auto grid = openvdb::gridPtrCast<FloatGrid>(named);
    if (!grid)
        throw std::runtime_error("grid '" + name + "' does not hold floats");
    return grid;
}

/* The direction of the gradient over one voxel at a position in index space: of unit length, or 0 if the field is flat. */
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

/* Trilinear interpolation over active samples only, with weights that are normalised, so that the empty side of a surface does not dilute
 * the value. If no corner is active, the mean of the active voxels around them; 0 if there are none. */
template <class accessor, class number_fn>
float value_at(const accessor &at, const number_fn &number, const Vec3d &x)
{
    const Coord lo = Coord::floor(x);
    const double t[3] = {x[0] - lo[0], x[1] - lo[1], x[2] - lo[2]};
    double sum = 0, weight = 0;
    typename accessor::ValueType v;
    for (int c = 0; c < 8; c++) {
        const int d[3] = {c & 1, c >> 1 & 1, c >> 2};
        double w = 1;
        for (int a = 0; a < 3; a++)
            w *= d[a] ? t[a] : 1 - t[a];
        if (w > 1e-9 && at.probeValue(lo.offsetBy(d[0], d[1], d[2]), v)) {
            sum += w * double(number(v));
            weight += w;
        }
    }
    if (weight == 0)
        for (int c = 0; c < 64; c++)
            if (at.probeValue(lo.offsetBy((c & 3) - 1, (c >> 2 & 3) - 1, (c >> 4) - 1), v)) {
                sum += double(number(v));
                weight += 1;
            }
    return weight > 0 ? float(sum / weight) : 0;
}

/* The box of a level set's active samples, in the simulator's axes, enlarged by one sample on every side. */
struct box_of_samples {
    trimesh_lattice lattice{};
    Coord lo;

    box_of_samples(const FloatGrid &grid, bool y_up)
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
        lo = Coord::minComponent(a, b);
        const Coord hi = Coord::maxComponent(a, b);
        const Vec3d origin = vdb::sim_from_file(grid.indexToWorld(Vec3d(0)), y_up);
        lattice.voxel = voxel;
        for (int d = 0; d < 3; d++) {
            lattice.n[d] = hi[d] - lo[d] + 1;
            lattice.origin[d] = origin[d] + voxel * lo[d];
        }
    }
};

status send_samples(const FloatGrid &grid, const box_of_samples &box, bool y_up, struct serve_answer *answer)
{
    const trimesh_lattice &l = box.lattice;
    const FloatGrid::ConstAccessor at = grid.getConstAccessor();
    std::vector<float> layer(size_t(l.n[0]) * size_t(l.n[1]));
    status st = serve_begin_part(answer);
    for (int z = 0; z < l.n[2] && st == OK; z++) {
        float *to = layer.data();
        for (int y = 0; y < l.n[1]; y++)
            for (int x = 0; x < l.n[0]; x++)
                *to++ = at.getValue(vdb::file_from_sim(box.lo.offsetBy(x, y, z), y_up));
        st = serve_append(answer, layer.data(), layer.size() * sizeof layer[0]);
    }
    return st;
}

/* Reads the requested positions and converts them to the file's axes. */
status read_places(const struct serve_question *q, bool y_up, std::vector<Vec3d> *out)
{
    std::vector<float> x(size_t(q->n_input / sizeof(float)));
    const status st = serve_input(q, x.data(), x.size() * sizeof x[0], 0);
    out->resize(x.size() / 3);
    for (size_t i = 0; i < out->size(); i++)
        (*out)[i] = vdb::file_from_sim(Vec3d(Vec3s(&x[3 * i])), y_up);
    return st;
}

status send_normals(const FloatGrid &surface, const std::vector<Vec3d> &place, bool y_up,
                    struct serve_answer *answer)
{
    const FloatGrid::ConstAccessor at = surface.getConstAccessor();
    std::vector<float> normal(3 * place.size());
    for (size_t i = 0; i < place.size(); i++) {
        const Vec3d n = vdb::sim_from_file(gradient(at, surface.worldToIndex(place[i])), y_up);
        for (int a = 0; a < 3; a++)
            normal[3 * i + size_t(a)] = float(n[a]);
    }
    return serve_add_part(answer, normal.data(), normal.size() * sizeof normal[0]);
}

template <class grid_type, class number_fn>
void values_of(const grid_type &grid, const number_fn &number, const std::vector<Vec3d> &place,
               std::vector<float> *out)
{
    const auto at = grid.getConstAccessor();
    for (size_t i = 0; i < place.size(); i++)
        (*out)[i] = value_at(at, number, grid.worldToIndex(place[i]));
}

/* Sends the values of one grid. If the grid may be missing and is, they are 0. */
status send_values(const vdb::file &file, const std::string &word, bool may_lack,
                   const std::vector<Vec3d> &place, struct serve_answer *answer)
{
    std::vector<float> value(place.size());
    const size_t dot = word.find('.');
    const std::string name = word.substr(0, dot);
    if (may_lack && !file.grid(name)) {
        ; /* zeros */
    } else if (dot == std::string::npos) {
        values_of(
            *float_grid(file, name), [](float v) { return v; }, place, &value);
    } else {
        const auto grid =
            file.grid(name) ? openvdb::gridPtrCast<openvdb::Vec3SGrid>(file.grid(name)) : nullptr;
        const int component = word[dot + 1] - 'x';
        if (!grid || component < 0 || component > 2)
            throw std::runtime_error("it has no vectors '" + name + "'");
        values_of(
            *grid, [&](const Vec3s &v) { return vdb::sim_from_file(v, file.y_up)[component]; }, place,
            &value);
    }
    return serve_add_part(answer, value.data(), value.size() * sizeof value[0]);
}
} // namespace

extern "C" status vdb_serve_surface(const struct serve_question *q, struct serve_answer *answer)
try {
    vdb::file file;
    status st = vdb::load(q->path, &file);
    if (st != OK)
        return st;
    const FloatGrid::Ptr surface = float_grid(file, "surface");
    const box_of_samples box(*surface, file.y_up);
    st = serve_add_part(answer, &box.lattice, sizeof box.lattice);
    return st == OK ? send_samples(*surface, box, file.y_up, answer) : st;
}
SHIM_CATCH(E_INPUT, q->path)

extern "C" status vdb_serve_at(const struct serve_question *q, struct serve_answer *answer)
try {
    vdb::file file;
    std::vector<Vec3d> place;
    status st = vdb::load(q->path, &file);
    if (st == OK)
        st = read_places(q, file.y_up, &place);
    if (st == OK && q->n_arguments < 2)
        st = fail(E_INPUT, "%s: its reader lacks an argument", q->path);
    if (st == OK && *q->argument[0] == '1')
        st = send_normals(*float_grid(file, "surface"), place, file.y_up, answer);
    const size_t optional = st == OK ? size_t(std::atoi(q->argument[1])) : 0;
    for (size_t k = 2; k < q->n_arguments && st == OK; k++)
        st = send_values(file, q->argument[k], k + optional >= q->n_arguments, place, answer);
    return st;
}
SHIM_CATCH(E_INPUT, q->path)
