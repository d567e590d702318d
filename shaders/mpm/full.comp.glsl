#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of voxel bits: the voxels that resting rock fills by more than half, against which single particles
// collide (gather.comp.glsl).
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
READ_F(1, fill)
WRITE_U(2, full)
PARAMS(mpm_params)
#include "mpm/voxels.glsl"
#include "particles/held.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint full_bits = deep_word(i), s = LOAD_U(words, HELD_STRIDE * i + 1u);
    for (uint bits = LOAD_U(words, HELD_STRIDE * i); bits != 0u; bits &= bits - 1u)
        if (LOAD_F(fill, s++) > 0.5)
            full_bits |= bits & (~bits + 1u);
    AT(full, i) = full_bits;
}
