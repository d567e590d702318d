#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of bits: writes the number of each of its held voxels to the list, at the voxel's slot.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
WRITE_U(1, list)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint slot = LOAD_U(words, HELD_STRIDE * i + 1u);
    for (uint bits = LOAD_U(words, HELD_STRIDE * i); bits != 0u; bits &= bits - 1u)
        AT(list, slot++) = 32u * i + uint(findLSB(bits));
}
