#include "scene/mesh_sdf_make.h"

#include <exception>
#include <new>
#include <vector>

#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/task_arena.h>

struct vdb_sdf {
    openvdb::FloatGrid::Ptr grid;
};

/* The voxel in the middle of the vertices' box. */
static openvdb::Coord middle_of(const double (*vertex)[3], size_t n, double voxel)
{
    openvdb::BBoxd box;
    for (size_t i = 0; i < n; i++)
        box.expand(openvdb::Vec3d(vertex[i]));
    return n ? openvdb::Coord::round(box.getCenter() / voxel) : openvdb::Coord();
}

extern "C" status sdf_make(const double (*vertex)[3], size_t n_vertices, const uint32_t (*triangle)[3],
                           size_t n_triangles, double voxel, double band, struct vdb_sdf **out)
{
    try {
        /* What the library has compiled takes floats. About the mesh's own middle, and that is a whole number of voxels off,
         * they are as good as doubles. */
        const openvdb::Coord middle = middle_of(vertex, n_vertices, voxel);
        std::vector<openvdb::Vec3s> point(n_vertices);
        for (size_t i = 0; i < n_vertices; i++)
            for (int a = 0; a < 3; a++)
                point[i][a] = float(vertex[i][a] / voxel - middle[a]);
        std::vector<openvdb::Vec3I> corners(n_triangles);
        for (size_t t = 0; t < n_triangles; t++)
            corners[t] = openvdb::Vec3I(triangle[t]);
        const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> mesh(point, corners);
        openvdb::math::Transform::Ptr transform = openvdb::math::Transform::createLinearTransform(voxel);
        transform->postTranslate(middle.asVec3d() * voxel);
        const float voxels = float(band / voxel);
        openvdb::FloatGrid::Ptr grid;
        openvdb::util::NullInterrupter never;
        /* One thread: where two triangles are equally near, the winner must not depend on who came first. */
        tbb::task_arena alone(1);
        alone.execute([&] {
            grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
                never, mesh, *transform, voxels, voxels, 0, static_cast<openvdb::Int32Grid *>(nullptr));
        });
        *out = new vdb_sdf{grid};
        return OK;
    } catch (const std::bad_alloc &) {
        return fail(E_MEMORY, "out of memory: sampling a mesh of %zu triangles at %g m", n_triangles, voxel);
    } catch (const std::exception &e) {
        return fail(E_INPUT, "a mesh of %zu triangles cannot be sampled at %g m: %s", n_triangles, voxel,
                    e.what());
    } catch (...) {
        return fail(E_INPUT, "a mesh of %zu triangles cannot be sampled at %g m", n_triangles, voxel);
    }
}

extern "C" void sdf_destroy(struct vdb_sdf **sdf)
{
    delete *sdf;
    *sdf = nullptr;
}

extern "C" double sdf_at(const struct vdb_sdf *sdf, const double x[3])
{
    /* An accessor of the unregistered kind costs nothing to make, and finds the other corners without the
     * tree. */
    openvdb::FloatGrid::ConstUnsafeAccessor accessor(sdf->grid->constTree());
    const openvdb::Vec3d index = sdf->grid->transform().worldToIndex(openvdb::Vec3d(x[0], x[1], x[2]));
    return double(openvdb::tools::BoxSampler::sample(accessor, index));
}
