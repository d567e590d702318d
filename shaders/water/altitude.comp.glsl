#version 460
#extension GL_GOOGLE_include_directive : require
// Per span: the altitude of its floor in 2^-16 cells: the floor of its lowest cell plus that cell's share of
// rock, which follows a slope much more finely than a voxel. A random roughness of up to 1/64 cell keeps level
// ground from draining in the order of numbers. Bare ground is 0.
#include "shared/buffers.glsl"
#include "shared/params.h"
#include "shared/random.glsl"

READ_U(0, cell)
READ_U(1, words)
READ_U(2, start)
READ_F(3, viability)
WRITE_U(4, altitude)
PARAMS(water_params)
#include "water/cell_of.glsl"
#include "water/voxels.glsl"
#define HELD_NX k.vx
#define HELD_NY k.vy
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint at = LOAD_U(cell, i);
    uvec3 c = cell_of(at), low, high;
    cell_voxels(c, low, high);
    bool rock = false;
    float sum = 0.0;
    for (uint z = low.z; z < high.z; z++)
        for (uint y = low.y; y < high.y; y++) {
            uvec2 row = row_particles(int(low.x), int(high.x) - 1, int(y), int(z));
            for (uint j = row.x; j < row.y; j++) {
                sum += max(LOAD_F(viability, j), 0.0);
                rock = true;
            }
        }
    float columns = float((high.x - low.x) * (high.y - low.y));
    if (c.z == 0u)
        sum += float(k.sz) * columns; // the half of a cell that is below the ground
    uint share = min(uint(sum / columns * (64512.0 / float(k.size))), 64512u);
    AT(altitude, i) = rock ? (c.z << 16u) + share + (random_hash(k.random, at, 0u, RANDOM_ROUGHNESS) & 1023u) : 0u;
}
