#version 460
#extension GL_GOOGLE_include_directive : require
// Each cell's share of rock: the viability of the particles in its eight voxels, over eight.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
READ_U(1, start)
READ_F(2, viability)
WRITE_F(3, fill)
PARAMS(stress_params)
#include "stress/grid.glsl"
#define HELD_NX (2u * (k.cx - 2u))
#define HELD_NY (2u * (k.cy - 2u))
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint nx = k.cx - 2u, ny = k.cy - 2u;
    uvec3 c = uvec3(i % nx, (i / nx) % ny, i / (nx * ny));
    float sum = 0.0;
    for (uint z = 0u; z < 2u; z++)
        for (uint y = 0u; y < 2u; y++) {
            uvec2 row = row_particles(int(2u * c.x), int(2u * c.x + 1u), int(2u * c.y + y), int(2u * c.z + z));
            for (uint j = row.x; j < row.y; j++)
                sum += LOAD_F(viability, j);
        }
    AT(fill, cell_index(ivec3(c) + 1)) = min(sum / 8.0, 1.0);
}
