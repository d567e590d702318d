#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: sets the bit of its voxel, unless nothing is left of the particle.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
READ_F(1, viability)
WRITE_U(2, words)
PARAMS(voxel_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n || LOAD_F(viability, i) <= 0.0)
        return;
    ivec3 v = voxel_of(LOAD_V(position, i).xyz);
    atomicOr(AT(words, HELD_STRIDE * voxel_word(v) + 2u), voxel_bit(v));
}
