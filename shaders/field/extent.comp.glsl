#version 460
#extension GL_GOOGLE_include_directive : require
// Where in each brick a grid is not 0: see field/extent.glsl.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, value)
WRITE_U(1, extent)
PARAMS(field_params)
#include "field/lattice.glsl"
#include "particles/voxel.glsl"

float value_at(ivec3 v)
{
    return LOAD_F(value, voxel_index(v));
}
#include "field/extent.glsl"

void main()
{
    uint brick = THREAD;
    if (brick < k.n)
        AT(extent, brick) = extent_of(brick);
}
