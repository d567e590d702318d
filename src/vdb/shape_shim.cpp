/* Makes a mesh of the surface of a level set or fog in any OpenVDB file, or recovers the solid of a frame of hoodoo's. Runs in hoodoo-read. */
#include "vdb/solid.hpp"

extern "C" {
#include "reader/mesh_part.h"
#include "vdb/serve.h"
}

#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace
{
using openvdb::FloatGrid;
using openvdb::GridBase;
using openvdb::Vec3d;

/* The grid with that name or, if it is "", the first grid of floats; *choices: how many there are. The error message lists the file's
 * grids. */
FloatGrid::Ptr choose(const vdb::file &file, const std::string &name, uint32_t *choices)
{
    std::string there;
    *choices = 0;
    for (const GridBase::Ptr &grid : *file.grids)
        *choices += name.empty() ? grid->isType<FloatGrid>() || grid->isType<openvdb::DoubleGrid>()
                                 : grid->getName() == name;
    for (const GridBase::Ptr &grid : *file.grids) {
        const bool floats = grid->isType<FloatGrid>() || grid->isType<openvdb::DoubleGrid>();
        there += (there.empty() ? "'" : ", '") + grid->getName() + "'" + (floats ? "" : " (no floats)");
        if (!(name.empty() ? floats : grid->getName() == name))
            continue;
        if (!floats)
            throw std::runtime_error("grid '" + name + "' does not hold floats");
        if (const auto same = openvdb::gridPtrCast<FloatGrid>(grid))
            return same;
        const auto wide = openvdb::gridPtrCast<openvdb::DoubleGrid>(grid);
        const auto tree = std::make_shared<openvdb::FloatTree>(wide->tree());
        const auto made = FloatGrid::create(tree);
        made->setTransform(wide->transform().copy());
        made->setGridClass(wide->getGridClass());
        made->setName(wide->getName());
        return made;
    }
    throw std::runtime_error(name.empty() ? "it has no grid of floats"
                                          : "it has no grid '" + name + "': there is " +
                                                (there.empty() ? "none" : there));
}

/* Moves a vertex to where the grid, interpolated by parabolas, has the value iso. The library interpolates linearly and averages vertices,
 * which shrinks round shapes: a ball of 15 voxels' radius by half a percent. */
void refine_vertex(const FloatGrid &grid, double iso, openvdb::Vec3s &point)
{
    const FloatGrid::ConstAccessor at = grid.getConstAccessor();
    const Vec3d first = grid.worldToIndex(Vec3d(point));
    Vec3d x = first;
    for (int step = 0; step < 4; step++) {
        Vec3d slope;
        for (int a = 0; a < 3; a++) {
            Vec3d d(0);
            d[a] = 0.25;
            slope[a] = 2 * (double(openvdb::tools::QuadraticSampler::sample(at, x + d)) -
                            double(openvdb::tools::QuadraticSampler::sample(at, x - d)));
        }
        const double square = slope.lengthSqr();
        if (!(square > 0))
            return;
        x -= slope * ((double(openvdb::tools::QuadraticSampler::sample(at, x)) - iso) / square);
        if (!((x - first).lengthSqr() < 1))
            return;
    }
    point = openvdb::Vec3s(grid.indexToWorld(x));
}

status send(const FloatGrid &grid, double iso, bool is_fog, bool y_up, uint32_t choices,
            struct serve_answer *answer)
{
    std::vector<openvdb::Vec3s> point;
    std::vector<openvdb::Vec3I> triangle;
    std::vector<openvdb::Vec4I> quad;
    openvdb::tools::volumeToMesh(grid, point, triangle, quad, iso, 0);
    for (openvdb::Vec3s &p : point)
        refine_vertex(grid, iso, p);
    struct mesh_part part = {};
    part.n_vertices = point.size();
    part.n_triangles = triangle.size() + 2 * quad.size();
    part.y_up = y_up;
    part.is_fog = is_fog;
    part.n_choices = choices;
    std::strncpy(part.grid, grid.getName().c_str(), sizeof part.grid - 1);
    status st = serve_add_part(answer, &part, sizeof part);
    std::vector<double> place;
    for (const openvdb::Vec3s &p : point)
        place.insert(place.end(), {double(p[0]), double(p[1]), double(p[2])});
    if (st == OK)
        st = serve_add_part(answer, place.data(), place.size() * sizeof place[0]);
    std::vector<uint32_t> corner;
    /* The library's faces are clockwise as seen from outside, if the grid's class is right. */
    const auto put = [&](uint32_t a, uint32_t b, uint32_t c) { corner.insert(corner.end(), {a, c, b}); };
    for (const openvdb::Vec3I &t : triangle)
        put(t[0], t[1], t[2]);
    for (const openvdb::Vec4I &f : quad) {
        put(f[0], f[1], f[2]);
        put(f[0], f[2], f[3]);
    }
    return st == OK ? serve_add_part(answer, corner.data(), corner.size() * sizeof corner[0]) : st;
}
status send_solid(const vdb::solid &solid, struct serve_answer *answer)
{
    struct mesh_part part = {};
    struct solid_part head = {};
    part.is_solid = 1;
    head.n = solid.value.size();
    head.voxel = solid.voxel;
    head.filled = solid.filled;
    std::memcpy(head.origin, solid.origin, sizeof head.origin);
    status st = serve_add_part(answer, &part, sizeof part);
    if (st == OK)
        st = serve_add_part(answer, &head, sizeof head);
    if (st == OK)
        st = serve_add_part(answer, solid.at.data(), solid.at.size() * sizeof solid.at[0]);
    if (st == OK)
        st = serve_add_part(answer, solid.value.data(), solid.value.size() * sizeof solid.value[0]);
    return st;
}
} // namespace

extern "C" status vdb_serve_shape(const struct serve_question *q, struct serve_answer *answer)
try {
    vdb::file file;
    status st = q->n_arguments == 2 ? vdb::load(q->path, &file)
                                    : fail(E_INPUT, "%s: its reader lacks an argument", q->path);
    if (st != OK)
        return st;
    vdb::solid solid;
    if (!*q->argument[0] && vdb::find_solid(file, &solid))
        return send_solid(solid, answer);
    uint32_t choices;
    const FloatGrid::Ptr grid = choose(file, q->argument[0], &choices);
    /* A grid without a class counts as a fog if no value is below 0. */
    bool is_fog = grid->getGridClass() == openvdb::GRID_FOG_VOLUME;
    if (grid->getGridClass() != openvdb::GRID_FOG_VOLUME && grid->getGridClass() != openvdb::GRID_LEVEL_SET)
        is_fog = !(grid->background() > 0);
    grid->setGridClass(is_fog ? openvdb::GRID_FOG_VOLUME : openvdb::GRID_LEVEL_SET);
    return send(*grid, is_fog ? std::atof(q->argument[1]) : 0, is_fog, file.y_up, choices, answer);
}
SHIM_CATCH(E_INPUT, q->path)
