#version 460
#extension GL_GOOGLE_include_directive : require
// What the rock around a sample carries: means of stress, von Mises stress and viability, and the share of
// deposits, over the particles
// of the sample's voxel and its neighbours, weighted as in the rock's share; 0 where there are none.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
READ_U(1, start)
READ_F(2, stress)
READ_F(3, von_mises)
READ_F(4, viability)
READ_U(5, phase)
READ_U(6, list)
READ_F(7, share)
WRITE_V(8, means)
PARAMS(field_params)
#include "field/lattice.glsl"
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"

vec4 sum = vec4(0.0);
float weights = 0.0;

void add(ivec3 v, float weight)
{
    if (!voxel_inside(v))
        return;
    uvec2 in_voxel = voxel_particles(v);
    for (uint j = in_voxel.x; j < in_voxel.y; j++) {
        sum += weight * vec4(LOAD_F(stress, j), LOAD_F(von_mises, j), LOAD_F(viability, j),
                             LOAD_U(phase, j) == PHASE_DEPOSIT ? 1.0 : 0.0);
        weights += weight;
    }
}
#include "field/around.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    if (LOAD_F(share, i) > 0.0)
        add_around(brick_sample(LOAD_U(list, i / BRICK_SAMPLES), i % BRICK_SAMPLES) - int(k.margin));
    AT(means, i) = weights > 0.0 ? sum / weights : vec4(0.0);
}
