#version 460
#extension GL_GOOGLE_include_directive : require
// A coarse cell's share of the full stiffness: the mean of its eight children's, those outside counting nothing.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, fill)
WRITE_F(1, coarse)
PARAMS(coarse_params)
#include "stress/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint nx = k.px - 2u, ny = k.py - 2u;
    ivec3 c = ivec3(i % nx, (i / nx) % ny, i / (nx * ny)) + 1;
    float sum = 0.0;
    for (int e = 0; e < 8; e++) {
        ivec3 child = min(2 * c - 1 + ivec3(e & 1, (e >> 1) & 1, e >> 2), ivec3(k.cx, k.cy, k.cz) - 1);
        sum += stiffness(LOAD_F(fill, cell_index(child)));
    }
    AT(coarse, (uint(c.z) * k.py + uint(c.y)) * k.px + uint(c.x)) = sum / 8.0;
}
