#version 460
#extension GL_GOOGLE_include_directive : require
// Resting rock as single particles meet it: the bits of the voxels that it fills by more than a half.
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
