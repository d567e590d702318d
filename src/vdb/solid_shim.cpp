/* Recovers the solid of a frame from its volumes.
 *
 * The grid `surface` is the level 1/2 of the rock's share, which is smoothed: edges are rounded, and a ball of six voxels' radius is 2 %
 * smaller. The grid `density` is that share itself, a linear filter of the voxels' fill (shaders/particles/share.glsl):
 *
 *   density = K fill,  0 <= fill <= 1
 *
 * 1. Fill      The least squares solution, by accelerated projected gradients (Beck and Teboulle 2009, FISTA). Most voxels are known: where
 *              the density is 0 or 1, the fill is, too.
 * 2. Surface   A trilinear function whose negative part of each voxel has the voxel's fill, found by moving each sample in proportion to
 *              the difference.
 */
#include "vdb/solid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <tbb/parallel_for.h>

extern "C" {
#include "shared/params.h"
}

namespace
{
using openvdb::Coord;
using openvdb::FloatGrid;

constexpr int32_t OUTSIDE = -1, INSIDE = -2; /* neighbours that are not in the list */
constexpr float NEARLY = 5e-4f;              /* from 0 or 1; files may have half floats */
constexpr int NEIGHBOURS = 27, MIDDLE = 13;

/* The offset of neighbour k along an axis: -1, 0 or 1. */
int offset(int k, int axis)
{
    return axis == 0 ? k % 3 - 1 : axis == 1 ? k / 3 % 3 - 1 : k / 9 - 1;
}

/* The filter's weight of neighbour k. */
float weight(int k)
{
    const int axes = std::abs(offset(k, 0)) + std::abs(offset(k, 1)) + std::abs(offset(k, 2));
    return axes == 0 ? SHARE_SELF : axes == 1 ? SHARE_FACE : axes == 2 ? SHARE_EDGE : 0;
}

struct lattice {
    int n[3], margin[3];
    bool wall[2][2]; /* by axis and side */
};

/* The samples near the surface, and their neighbours, continued as mirror images beyond walls. */
struct samples {
    std::vector<Coord> at; /* in the simulator's axes */
    std::vector<float> density, fill, value;
    std::vector<std::array<int32_t, NEIGHBOURS>> beside;

    template <class T> T of(const std::vector<T> &v, int32_t i, T inside) const
    {
        return i >= 0 ? v[size_t(i)] : i == INSIDE ? inside : T(0);
    }
    bool is_partial(size_t i) const
    {
        return density[i] > NEARLY && density[i] < 1 - NEARLY;
    }
};

/* A side is a wall if the rock is cut off there: beyond an open side its share fades. */
void find_walls(lattice &l, const openvdb::FloatTree &density, bool y_up)
{
    for (auto v = density.cbeginValueOn(); v; ++v) {
        if (!v.isVoxelValue() || !(*v > 1 - NEARLY))
            continue;
        const Coord s = vdb::sim_from_file(v.getCoord(), y_up);
        for (int a = 0; a < 2; a++) {
            l.wall[a][0] |= s[a] == l.margin[a];
            l.wall[a][1] |= s[a] == l.n[a] - 1 - l.margin[a];
        }
    }
}

Coord mirrored(const lattice &l, Coord s)
{
    for (int a = 0; a < 2; a++) {
        const int low = l.margin[a], high = l.n[a] - 1 - l.margin[a];
        if (l.wall[a][0] && s[a] < low)
            s[a] = 2 * low - 1 - s[a];
        if (l.wall[a][1] && s[a] > high)
            s[a] = 2 * high + 1 - s[a];
    }
    return s;
}

samples collect(const FloatGrid &density, const FloatGrid &surface, const lattice &l, bool y_up)
{
    samples s;
    openvdb::Int32Tree number(OUTSIDE);
    number.topologyUnion(surface.tree());
    number.voxelizeActiveTiles();
    for (auto v = density.cbeginValueOn(); v; ++v)
        if (v.isVoxelValue() && *v > NEARLY && *v < 1 - NEARLY)
            for (int k = 0; k < NEIGHBOURS; k++)
                number.setValueOn(v.getCoord().offsetBy(offset(k, 0), offset(k, 1), offset(k, 2)));
    const auto at = density.getConstAccessor();
    for (auto v = number.beginValueOn(); v; ++v) {
        v.setValue(int32_t(s.at.size()));
        s.at.push_back(vdb::sim_from_file(v.getCoord(), y_up));
        s.density.push_back(at.getValue(v.getCoord()));
    }
    s.beside.resize(s.at.size());
    openvdb::tree::ValueAccessor<const openvdb::Int32Tree> listed(number);
    for (size_t i = 0; i < s.at.size(); i++)
        for (int k = 0; k < NEIGHBOURS; k++) {
            const Coord next = mirrored(l, s.at[i].offsetBy(offset(k, 0), offset(k, 1), offset(k, 2)));
            const Coord file = vdb::file_from_sim(next, y_up);
            const int32_t found = listed.getValue(file);
            s.beside[i][size_t(k)] = found >= 0 ? found : at.getValue(file) > 0.5f ? INSIDE : OUTSIDE;
        }
    return s;
}

/* ---- fill */

float filtered(const samples &s, const std::vector<float> &v, size_t i, float inside)
{
    float sum = 0;
    for (int k = 0; k < NEIGHBOURS; k++)
        if (weight(k) > 0)
            sum += weight(k) * s.of(v, s.beside[i][size_t(k)], inside);
    return sum;
}

void find_fill(samples &s)
{
    constexpr int MOST = 150;
    constexpr float ACCURATE = 5e-4f;
    const size_t n = s.at.size();
    std::vector<uint32_t> unknown, rows;
    std::vector<bool> is_row(n, false);
    s.fill.resize(n);
    for (size_t i = 0; i < n; i++) {
        s.fill[i] = std::min(std::max(s.density[i], 0.f), 1.f);
        if (!s.is_partial(i)) {
            s.fill[i] = std::round(s.fill[i]);
            continue;
        }
        unknown.push_back(uint32_t(i));
        for (int k = 0; k < NEIGHBOURS; k++)
            if (s.beside[i][size_t(k)] >= 0)
                is_row[size_t(s.beside[i][size_t(k)])] = true;
    }
    for (size_t i = 0; i < n; i++)
        if (is_row[i])
            rows.push_back(uint32_t(i));
    std::vector<float> ahead = s.fill, rest(n, 0);
    float t = 1, largest = 1;
    for (int step = 0; step < MOST && largest > ACCURATE; step++) {
        largest = 0;
        for (const uint32_t i : rows) {
            rest[i] = s.density[i] - filtered(s, ahead, i, 1);
            largest = std::max(largest, std::fabs(rest[i]));
        }
        const float next = (1 + std::sqrt(1 + 4 * t * t)) / 2, more = (t - 1) / next;
        for (const uint32_t i : unknown)
            s.value[i] = std::min(std::max(ahead[i] + filtered(s, rest, i, 0), 0.f), 1.f);
        for (const uint32_t i : unknown) {
            ahead[i] = s.value[i] + more * (s.value[i] - s.fill[i]);
            s.fill[i] = s.value[i];
        }
        t = next;
    }
}

/* ---- surface */

constexpr int SIDE = 4; /* subdivisions of a voxel */

/* The share of a voxel in which the trilinear function is negative. In each of the subdivisions the function counts as linear. */
float covered(const float near[NEIGHBOURS])
{
    float sum = 0;
    for (int c = 0; c < SIDE * SIDE * SIDE; c++) {
        const int at[3] = {c % SIDE, c / SIDE % SIDE, c / SIDE / SIDE};
        float u[3], value[2][2][2];
        int first[3];
        for (int a = 0; a < 3; a++) {
            const float x = (float(at[a]) + 0.5f) / SIDE - 0.5f;
            first[a] = x < 0 ? 0 : 1;
            u[a] = x < 0 ? x + 1 : x;
        }
        for (int k = 0; k < 8; k++)
            value[k & 1][k >> 1 & 1][k >> 2] =
                near[first[0] + (k & 1) + 3 * (first[1] + (k >> 1 & 1)) + 9 * (first[2] + (k >> 2))];
        float f = 0, slope[3] = {0, 0, 0};
        for (int k = 0; k < 8; k++) {
            const int b[3] = {k & 1, k >> 1 & 1, k >> 2};
            float w[3];
            for (int a = 0; a < 3; a++)
                w[a] = b[a] ? u[a] : 1 - u[a];
            const float v = value[b[0]][b[1]][b[2]];
            f += w[0] * w[1] * w[2] * v;
            for (int a = 0; a < 3; a++)
                slope[a] += (b[a] ? v : -v) * w[(a + 1) % 3] * w[(a + 2) % 3];
        }
        const float across = std::fabs(slope[0]) + std::fabs(slope[1]) + std::fabs(slope[2]);
        sum += std::min(std::max(0.5f - f * SIDE / std::max(across, 1e-3f), 0.f), 1.f);
    }
    return sum / (SIDE * SIDE * SIDE);
}

/* Is there a value of the other sign among the sample and its neighbours? */
bool is_cut(const samples &s, size_t i)
{
    for (int k = 0; k < NEIGHBOURS; k++)
        if ((s.of(s.value, s.beside[i][size_t(k)], -0.5f) < 0) != (s.value[i] < 0))
            return true;
    return false;
}

void find_surface(samples &s)
{
    constexpr int STEPS = 40;
    constexpr float STILL = 1e-3f;
    const size_t n = s.at.size();
    std::vector<float> change(n, 1);
    std::vector<uint32_t> moving;
    for (size_t i = 0; i < n; i++)
        s.value[i] = 0.5f - s.fill[i];
    for (size_t i = 0; i < n; i++)
        if (is_cut(s, i) || (s.fill[i] > 0 && s.fill[i] < 1))
            moving.push_back(uint32_t(i));
    for (int step = 0; step < STEPS; step++) {
        std::vector<float> now(moving.size(), 0);
        const float gain = step < STEPS / 2 ? 0.6f : 0.3f;
        tbb::parallel_for(size_t(0), moving.size(), [&](size_t m) {
            const size_t i = moving[m];
            float near[NEIGHBOURS];
            bool changed = false;
            for (int k = 0; k < NEIGHBOURS; k++) {
                const int32_t b = s.beside[i][size_t(k)];
                near[k] = b >= 0 ? s.value[size_t(b)] : b == INSIDE ? -0.5f : 0.5f;
                changed |= b >= 0 && std::fabs(change[size_t(b)]) > STILL;
            }
            if (changed)
                now[m] = gain * (covered(near) - s.fill[i]);
        });
        for (size_t m = 0; m < moving.size(); m++) {
            float &value = s.value[moving[m]];
            const float to = std::min(std::max(value + now[m], -1.f), 1.f);
            change[moving[m]] = to - value;
            value = to;
        }
    }
}
} // namespace

namespace vdb
{
bool find_solid(const file &file, solid *out)
{
    const auto size = file.metadata->getMetadata<openvdb::Vec3IMetadata>(LATTICE);
    const auto density = openvdb::gridPtrCast<FloatGrid>(file.grid("density"));
    const auto surface = openvdb::gridPtrCast<FloatGrid>(file.grid("surface"));
    if (!size || !density || !surface || density->transform() != surface->transform() ||
        !density->hasUniformVoxels())
        return false;
    ::lattice l = {};
    const openvdb::Vec3d origin =
        sim_from_file(density->transform().indexToWorld(openvdb::Vec3d(0)), file.y_up);
    out->voxel = density->voxelSize()[0];
    for (int a = 0; a < 3; a++) {
        l.n[a] = size->value()[a];
        l.margin[a] = int(std::lround(0.5 - origin[a] / out->voxel));
        out->origin[a] = origin[a];
    }
    find_walls(l, density->tree(), file.y_up);
    samples s = collect(*density, *surface, l, file.y_up);
    s.value.resize(s.at.size());
    find_fill(s);
    find_surface(s);
    const auto distance = surface->getConstAccessor();
    for (size_t i = 0; i < s.at.size(); i++) {
        const float away =
            std::fabs(distance.getValue(file_from_sim(s.at[i], file.y_up))) / float(out->voxel);
        const float beside = is_cut(s, i) ? std::fabs(s.value[i]) / 2 : std::max(1.f, away - 0.75f);
        out->value.push_back(s.value[i] < 0 ? -beside : beside);
        for (int a = 0; a < 3; a++)
            out->at.push_back(s.at[i][a]);
    }
    out->filled = 0;
    for (auto v = density->cbeginValueOn(); v; ++v)
        out->filled += double(*v) * double(v.getVoxelCount());
    return true;
}
} // namespace vdb
