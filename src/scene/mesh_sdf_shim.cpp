#include "scene/mesh_sdf_make.h"

#include <exception>
#include <new>

#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/task_arena.h>

struct vdb_sdf {
    openvdb::FloatGrid::Ptr grid;
};

namespace
{

/* The mesh as meshToVolume() asks for it, without copying it. */
struct adapter {
    const double (*vertex)[3];
    size_t n_vertices;
    const uint32_t (*triangle)[3];
    size_t n_triangles;
    double voxel;

    size_t polygonCount() const
    {
        return n_triangles;
    }
    size_t pointCount() const
    {
        return n_vertices;
    }
    size_t vertexCount(size_t) const
    {
        return 3;
    }
    void getIndexSpacePoint(size_t polygon, size_t corner, openvdb::Vec3d &out) const
    {
        const double *x = vertex[triangle[polygon][corner]];
        out = openvdb::Vec3d(x[0] / voxel, x[1] / voxel, x[2] / voxel);
    }
};

} // namespace

extern "C" status sdf_make(const double (*vertex)[3], size_t n_vertices, const uint32_t (*triangle)[3],
                           size_t n_triangles, double voxel, double band, struct vdb_sdf **out)
{
    try {
        adapter mesh{vertex, n_vertices, triangle, n_triangles, voxel};
        openvdb::math::Transform::Ptr transform = openvdb::math::Transform::createLinearTransform(voxel);
        const float voxels = float(band / voxel);
        openvdb::FloatGrid::Ptr grid;
        /* One thread: where two triangles are equally near, the winner must not depend on who came first. */
        tbb::task_arena alone(1);
        alone.execute([&] {
            grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(mesh, *transform, voxels, voxels);
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
