#version 460
#extension GL_GOOGLE_include_directive : require
// How many voxels are held before each word, and which voxel each held one is.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, before)
WRITE_U(1, words)
WRITE_U(2, list)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint bits = AT(words, 2u * i), slot = LOAD_U(before, i);
    AT(words, 2u * i + 1u) = slot;
    for (; bits != 0u; bits &= bits - 1u)
        AT(list, slot++) = 32u * i + uint(findLSB(bits));
}
