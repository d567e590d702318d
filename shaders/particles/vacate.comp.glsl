#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of bits: only deep voxels remain occupied and none is held; their bits are stored in place of the
// held voxels'.
#include "shared/buffers.glsl"
#include "shared/params.h"

WRITE_U(0, words)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint deep = AT(words, HELD_STRIDE * i + 2u) & ~AT(words, HELD_STRIDE * i);
    AT(words, HELD_STRIDE * i) = deep;
    AT(words, HELD_STRIDE * i + 2u) = deep;
}
