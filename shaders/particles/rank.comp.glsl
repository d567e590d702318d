#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of bits: stores the number of held voxels before it, from the prefix sum.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, before)
WRITE_U(1, words)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(words, HELD_STRIDE * i + 1u) = LOAD_U(before, i);
}
