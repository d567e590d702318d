#version 460
#extension GL_GOOGLE_include_directive : require
// Voxels in which the surface field is inside the rock: what counts as connected is what can be seen to be.
// Threads thinner than a voxel hold nothing. Below the ground is more of the same.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
READ_U(1, list)
READ_F(2, fill)
WRITE_U(3, solid)
PARAMS(voxel_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#define GROUND_IS_ROCK
#include "particles/fill.glsl"
#include "particles/share.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    bool inside = false;
    if (LOAD_F(fill, i) > 0.0)
        inside = share_at(voxel_at(LOAD_U(list, i))) >= 0.5;
    AT(solid, i) = inside ? 1u : 0u;
}
