#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of bits: voxels whose particles are being created are no longer deep; they are occupied again once
// they have them.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, born)
WRITE_U(1, words)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(words, HELD_STRIDE * i + 2u) &= ~LOAD_U(born, i);
}
