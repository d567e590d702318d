#version 460
#extension GL_GOOGLE_include_directive : require
// Per held voxel: initial pointer, to the solid voxel right below, else to itself.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
READ_U(1, list)
READ_U(2, solid)
WRITE_U(3, pointer)
PARAMS(voxel_params)
#include "particles/bits.glsl"
#include "particles/held.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 v = voxel_at(LOAD_U(list, i));
    uint below = v.z > 0 && LOAD_U(solid, i) != 0u ? voxel_slot(v - ivec3(0, 0, 1)) : NOT_HELD;
    AT(pointer, i) = below != NOT_HELD && LOAD_U(solid, below) != 0u ? below : i;
}
