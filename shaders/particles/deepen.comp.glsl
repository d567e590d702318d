#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of bits: makes exactly the given voxels deep.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, bits)
WRITE_U(1, words)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    AT(words, HELD_STRIDE * i) &= ~LOAD_U(bits, i);
    AT(words, HELD_STRIDE * i + 2u) = AT(words, HELD_STRIDE * i) | LOAD_U(bits, i);
}
