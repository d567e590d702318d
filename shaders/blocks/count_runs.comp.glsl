#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of bits: number of runs of deep voxels that begin in it; 0 in the word after the last.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
WRITE_U(1, first)
PARAMS(runs_params)
#include "particles/bits.glsl"
#include "particles/held.glsl"
#define NO_NODES
#include "blocks/runs.glsl"

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(first, i) = i + 1u < k.n ? uint(bitCount(own_starts(i))) : 0u;
}
