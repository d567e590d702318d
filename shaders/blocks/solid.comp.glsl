#version 460
#extension GL_GOOGLE_include_directive : require
// Per held voxel: 1 if the surface field is inside the rock there (share >= 1/2), so that rock is connected
// where the visible surface is. Threads thinner than a voxel support nothing. Below z = 0 columns continue as
// in their lowest voxel.
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
#define GROUND_CONTINUES
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
