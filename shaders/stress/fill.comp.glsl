#version 460
#extension GL_GOOGLE_include_directive : require
// Each cell's share of rock: the viability of the particles in its eight voxels, over eight.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, start)
READ_F(1, viability)
WRITE_F(2, fill)
PARAMS(stress_params)
#include "stress/grid.glsl"

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
            uint v = ((2u * c.z + z) * (2u * ny) + 2u * c.y + y) * (2u * nx) + 2u * c.x;
            uint end = LOAD_U(start, v + 2u);
            for (uint j = LOAD_U(start, v); j < end; j++)
                sum += LOAD_F(viability, j);
        }
    AT(fill, cell_index(ivec3(c) + 1)) = min(sum / 8.0, 1.0);
}
