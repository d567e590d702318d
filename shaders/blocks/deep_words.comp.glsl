#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of bits: 1 if it has deep voxels.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
WRITE_U(1, flag)
PARAMS(count_params)
#define HELD_NX 0u
#define HELD_NY 0u
#include "particles/bits.glsl"
#include "particles/held.glsl"

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(flag, i) = deep_word(i) != 0u ? 1u : 0u;
}
