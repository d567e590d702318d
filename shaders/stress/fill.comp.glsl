#version 460
#extension GL_GOOGLE_include_directive : require
// Each kept cell's share of rock: the viability of the particles in its eight voxels, deep ones being whole, over eight.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, run)
READ_U(1, words)
READ_U(2, start)
READ_F(3, viability)
WRITE_F(4, fill)
PARAMS(stress_params)
#include "stress/grid.glsl"
#define HELD_NX (2u * (k.cx - 2u))
#define HELD_NY (2u * (k.cy - 2u))
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"

float rock_in(ivec3 v)
{
    if (voxel_deep(v))
        return 1.0;
    float sum = 0.0;
    uvec2 in_voxel = voxel_particles(v);
    for (uint j = in_voxel.x; j < in_voxel.y; j++)
        sum += LOAD_F(viability, j);
    return sum;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint own = LOAD_U(run, i / STRESS_RUN);
    ivec3 c = node_of(own, i, uvec3(k.cx, k.cy, k.cz)), cells = ivec3(k.cx, k.cy, k.cz);
    float sum = 0.0;
    if (own != STRESS_NO_RUN && all(greaterThanEqual(c, ivec3(1))) && all(lessThan(c, cells - 1)))
        for (int b = 0; b < 4; b++) {
            ivec3 v = 2 * (c - 1) + ivec3(0, b & 1, b >> 1);
            for (int x = v.x; x <= v.x + 1; x++)
                sum += rock_in(ivec3(x, v.yz));
        }
    AT(fill, i) = min(sum / 8.0, 1.0);
}
