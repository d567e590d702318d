#version 460
#extension GL_GOOGLE_include_directive : require
// All have seen what vanished: from here on nothing is newly gone.
#include "shared/buffers.glsl"
#include "shared/params.h"

WRITE_U(0, bits)
PARAMS(voxels_params)
#include "voxels/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(bits, word_number(i)) = 0u;
}
