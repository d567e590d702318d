#version 460
#extension GL_GOOGLE_include_directive : require
// A particle stays if its voxel, or one across a face of it, belongs to a block that stands on the ground.
// The others are taken out.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
READ_U(1, solid)
READ_U(2, root)
WRITE_F(3, viability)
WRITE_U(4, counts)
PARAMS(voxel_params)
#include "particles/voxel.glsl"

bool stands(ivec3 v)
{
    if (!voxel_inside(v))
        return false;
    uint i = voxel_index(v);
    return LOAD_U(solid, i) != 0u && LOAD_U(root, i) < k.nx * k.ny;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 v = voxel_of(LOAD_V(position, i).xyz);
    if (stands(v) || stands(v - ivec3(0, 0, 1)) || stands(v + ivec3(0, 0, 1)) || stands(v - ivec3(1, 0, 0)) ||
        stands(v + ivec3(1, 0, 0)) || stands(v - ivec3(0, 1, 0)) || stands(v + ivec3(0, 1, 0)))
        return;
    AT(viability, i) = 0.0;
    atomicAdd(AT(counts, COUNT_FALLEN), 1u);
}
