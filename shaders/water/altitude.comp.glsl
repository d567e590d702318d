#version 460
#extension GL_GOOGLE_include_directive : require
// The altitude of a span's floor, in 2^-16 cells: its cell's floor and the share of rock in it, which on a
// slope is exact to far less than a voxel. A roughness of 1/64 keeps level ground from draining by number.
// Bare ground is 0.
#include "shared/buffers.glsl"
#include "shared/params.h"
#include "shared/random.glsl"

READ_U(0, cell)
READ_U(1, start)
READ_F(2, viability)
WRITE_U(3, altitude)
PARAMS(water_params)
#include "water/cell_of.glsl"
#include "water/voxels.glsl"

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
            uint row = (z * k.vy + y) * k.vx, end = LOAD_U(start, row + high.x);
            for (uint j = LOAD_U(start, row + low.x); j < end; j++) {
                sum += LOAD_F(viability, j);
                rock = true;
            }
        }
    float columns = float((high.x - low.x) * (high.y - low.y));
    if (c.z == 0u)
        sum += float(k.sz) * columns; // the half of a cell that is below the ground
    uint share = min(uint(sum / columns * 32256.0), 64512u);
    AT(altitude, i) = rock ? (c.z << 16u) + share + (random_hash(k.random, at, 0u, RANDOM_ROUGHNESS) & 1023u) : 0u;
}
