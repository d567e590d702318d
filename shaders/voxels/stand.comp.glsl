#version 460
#extension GL_GOOGLE_include_directive : require
// Per voxel of the domain: 1 if it is solid and its block is on the ground, or if it is rock in the lowest
// slab.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, solid)
READ_U(1, root)
READ_F(2, left)
WRITE_U(3, stands_out)
PARAMS(voxels_params)
#include "voxels/grid.glsl"

void main()
{
    uint i = THREAD, slab = k.nx * k.ny;
    if (i >= k.n)
        return;
    bool stands = LOAD_U(solid, i) != 0u && LOAD_U(root, i) < slab;
    if (i < slab)
        stands = LOAD_F(left, voxel_bit(i % k.nx, i / k.nx, 0u)) > 0.0;
    AT(stands_out, i) = stands ? 1u : 0u;
}
