#version 460
#extension GL_GOOGLE_include_directive : require
// What the surface carries at each sample of the field: the mean of a value over the surface's particles (those
// with a normal) in the sample's voxel and its neighbours, weighted as in the rock's share; 0 where there are
// none.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, start)
READ_V(1, normal)
READ_F(2, value)
READ_U(3, list)
READ_F(4, share)
WRITE_F(5, mean)
PARAMS(field_params)
#include "field/lattice.glsl"
#include "particles/voxel.glsl"

vec2 sum = vec2(0.0);

void add(ivec3 v, float weight)
{
    if (!voxel_inside(v))
        return;
    uint c = voxel_index(v), end = LOAD_U(start, c + 1u);
    for (uint j = LOAD_U(start, c); j < end; j++)
        if (LOAD_V(normal, j).xyz != vec3(0.0))
            sum += weight * vec2(LOAD_F(value, j), 1.0);
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
