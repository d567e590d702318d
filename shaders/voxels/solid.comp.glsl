#version 460
#extension GL_GOOGLE_include_directive : require
// Per voxel of the domain: 1 if at least half of it is left, so that it can support others.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, left)
WRITE_U(1, solid)
PARAMS(voxels_params)
#include "voxels/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint v = voxel_bit(i % k.nx, (i / k.nx) % k.ny, i / (k.nx * k.ny));
    AT(solid, i) = LOAD_F(left, v) >= 0.5 ? 1u : 0u;
}
