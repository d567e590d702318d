#version 460
#extension GL_GOOGLE_include_directive : require
// Per held voxel: fill, the viability of its particles.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, start)
READ_F(1, viability)
WRITE_F(2, fill)
PARAMS(voxel_params)

void main()
{
    uint s = THREAD;
    if (s >= k.n)
        return;
    uint end = LOAD_U(start, s + 1u);
    float sum = 0.0;
    for (uint j = LOAD_U(start, s); j < end; j++)
        sum += LOAD_F(viability, j);
    AT(fill, s) = min(sum, 1.0);
}
