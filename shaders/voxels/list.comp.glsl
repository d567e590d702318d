#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of voxels: lists its active voxels in order, at the prefix sum of their counts.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, skin)
READ_U(1, place)
WRITE_U(2, list)
PARAMS(voxels_params)
#include "voxels/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint w = word_number(i), at = LOAD_U(place, i);
    for (uint m = LOAD_U(skin, w); m != 0u; m &= m - 1u)
        AT(list, at++) = w * 32u + uint(findLSB(m));
}
