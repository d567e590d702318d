#version 460
#extension GL_GOOGLE_include_directive : require
// Per sample: means of stress, von Mises stress and viability, and the share of deposits, over the particles of
// its voxel and the neighbours, with the weights of particles/share.glsl; 0 where there are none. Farther than
// NEAR_REACH voxels from an empty one there may be no particles: stress is 0 here (see model/inside.h), the
// others are the voxel's own.
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
READ_U(8, near)
WRITE_V(9, means)
PARAMS(field_params)
#include "field/lattice.glsl"
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"
#include "particles/sides.glsl"

vec4 sum = vec4(0.0);
float weights = 0.0;

bool is_near(ivec3 v)
{
    return !voxel_inside(v) || (LOAD_U(near, voxel_word(v)) & voxel_bit(v)) != 0u;
}

void add(ivec3 v, float weight)
{
    v = side_voxel(v);
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

void add_deep()
{
    sum.z = 1.0;
    weights = 1.0;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 v = brick_sample(LOAD_U(list, i / BRICK_SAMPLES), i % BRICK_SAMPLES) - int(k.margin);
    bool all_around = is_near(v);
    if (LOAD_F(share, i) > 0.0) {
        if (all_around)
            add_around(v);
        else if (voxel_deep(v))
            add_deep();
        else
            add(v, 1.0);
    }
    vec4 mean = weights > 0.0 ? sum / weights : vec4(0.0);
    AT(means, i) = all_around ? mean : vec4(0.0, 0.0, mean.zw);
}
