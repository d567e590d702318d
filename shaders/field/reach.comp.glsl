#version 460
#extension GL_GOOGLE_include_directive : require
// Where in each brick there is rock: see field/extent.glsl.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
READ_F(1, fill)
WRITE_U(2, extent)
PARAMS(field_params)
#include "field/lattice.glsl"
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/fill.glsl"

float value_at(ivec3 v)
{
    return fill_at(v);
}
#include "field/extent.glsl"

void main()
{
    uint brick = THREAD;
    if (brick < k.n)
        AT(extent, brick) = extent_of(brick);
}
