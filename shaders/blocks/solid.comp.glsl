#version 460
#extension GL_GOOGLE_include_directive : require
// Voxels in which the surface field is inside the rock: what counts as connected is what can be seen to be.
// Threads thinner than a voxel hold nothing. Below the ground is more of the same.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, fill)
WRITE_U(1, solid)
PARAMS(voxel_params)
#include "particles/voxel.glsl"

float fill_at(ivec3 v)
{
    v.z = max(v.z, 0);
    return voxel_inside(v) ? LOAD_F(fill, voxel_index(v)) : 0.0;
}
#include "particles/share.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    bool inside = false;
    if (LOAD_F(fill, i) > 0.0)
        inside = share_at(ivec3(i % k.nx, (i / k.nx) % k.ny, i / (k.nx * k.ny))) >= 0.5;
    AT(solid, i) = inside ? 1u : 0u;
}
