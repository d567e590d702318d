#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: sort key, the slot of its voxel, or the number of held voxels if nothing is left of it.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
READ_F(1, viability)
READ_U(2, words)
WRITE_U(3, key)
PARAMS(voxel_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    bool dead = LOAD_F(viability, i) <= 0.0;
    AT(key, i) = voxel_rank(dead ? ivec3(0, 0, k.nz) : voxel_of(LOAD_V(position, i).xyz));
}
