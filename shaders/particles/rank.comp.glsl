#version 460
#extension GL_GOOGLE_include_directive : require
// How many voxels are held before each word.
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
