#version 460
#extension GL_GOOGLE_include_directive : require
// What the rock around a sample carries: means of stress, von Mises stress and viability, and the share of
// deposits, over the particles
// of the sample's voxel and its neighbours, weighted as in the rock's share; 0 where there are none.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, start)
READ_F(1, stress)
READ_F(2, von_mises)
READ_F(3, viability)
READ_U(4, phase)
READ_U(5, list)
READ_F(6, share)
WRITE_V(7, means)
PARAMS(field_params)
#include "field/lattice.glsl"
#include "particles/voxel.glsl"

vec4 sum = vec4(0.0);
float weights = 0.0;

void add(ivec3 v, float weight)
{
    if (!voxel_inside(v))
        return;
    uint c = voxel_index(v), end = LOAD_U(start, c + 1u);
    for (uint j = LOAD_U(start, c); j < end; j++) {
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
