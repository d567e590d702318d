#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of voxels: clears the bits of gone voxels at the end of a cycle.
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
