#version 460
#extension GL_GOOGLE_include_directive : require
// One component of a vector that particles carry, at each sample of the field: its mean over the particles of the sample's voxel
// and its neighbours, weighted as in the rock's share; 0 where there are none.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
READ_U(1, start)
READ_V(2, vector)
READ_U(3, list)
READ_F(4, share)
WRITE_F(5, mean)
PARAMS(field_params)
#include "field/lattice.glsl"
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"
#include "particles/sides.glsl"

vec2 sum = vec2(0.0);

void add(ivec3 v, float weight)
{
    v = side_voxel(v);
    if (!voxel_inside(v))
        return;
    uvec2 in_voxel = voxel_particles(v);
    for (uint j = in_voxel.x; j < in_voxel.y; j++)
        sum += weight * vec2(LOAD_V(vector, j)[k.component], 1.0);
}
#include "field/around.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    if (LOAD_F(share, i) > 0.0)
        add_around(brick_sample(LOAD_U(list, i / BRICK_SAMPLES), i % BRICK_SAMPLES) - int(k.margin));
    AT(mean, i) = sum.y > 0.0 ? sum.x / sum.y : 0.0;
}
