/* A solid that reaches the border of its grid, such as rock on the domain's floor, made to end there. Without
 * this the level set would have an inside without a surface around it, and its mesh a hole. */
#include "output/vdb_shim.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace
{
bool reaches_border(const float *value, const int n[3])
{
    const size_t nx = size_t(n[0]), ny = size_t(n[1]), nz = size_t(n[2]);
    for (size_t k = 0; k < nz; k++)
        for (size_t j = 0; j < ny; j++) {
            const float *row = value + (k * ny + j) * nx;
            const bool whole = k == 0 || k == nz - 1 || j == 0 || j == ny - 1;
            if (row[0] < 0 || row[nx - 1] < 0 ||
                (whole && std::any_of(row, row + nx, [](float v) { return v < 0; })))
                return true;
        }
    return false;
}

/* Signed distance, in voxels, of a voxel to the box that ends half a voxel beyond the outermost samples. */
double box_distance(const int i[3], const int n[3])
{
    double inside = -1e30, outside = 0;
    for (int a = 0; a < 3; a++) {
        const double d = std::max(-0.5 - i[a], i[a] - (n[a] - 0.5));
        inside = std::max(inside, d);
        outside += d > 0 ? d * d : 0;
    }
    return outside > 0 ? std::sqrt(outside) : inside;
}
} // namespace

std::vector<float> vdb::close_at_border(const float *value, const int n[3], double voxel)
{
    std::vector<float> closed;
    if (!reaches_border(value, n))
        return closed;
    const int m[3] = {n[0] + 2 * PAD, n[1] + 2 * PAD, n[2] + 2 * PAD};
    closed.resize(size_t(m[0]) * size_t(m[1]) * size_t(m[2]));
    tbb::parallel_for(0, m[2], [&](int z) {
        float *to = closed.data() + size_t(z) * size_t(m[1]) * size_t(m[0]);
        for (int y = 0; y < m[1]; y++)
            for (int x = 0; x < m[0]; x++) {
                const int i[3] = {x - PAD, y - PAD, z - PAD};
                size_t near[3];
                for (int a = 0; a < 3; a++)
                    near[a] = size_t(std::clamp(i[a], 0, n[a] - 1));
                const float v = value[(near[2] * size_t(n[1]) + near[1]) * size_t(n[0]) + near[0]];
                *to++ = std::max(v, float(box_distance(i, n) * voxel));
            }
    });
    return closed;
}
