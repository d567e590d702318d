#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of bits: marks and counts the deep voxels whose particles must be created: those near the surface,
// or all of them with k.all.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, near)
READ_U(1, words)
WRITE_U(2, born)
WRITE_U(3, counts)
PARAMS(born_params)
#define HELD_NX 0u
#define HELD_NY 0u
#include "particles/bits.glsl"
#include "particles/held.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint bits = deep_word(i) & (k.all != 0u ? 0xffffffffu : LOAD_U(near, i));
    AT(born, i) = bits;
    if (bits != 0u)
        atomicAdd(AT(counts, COUNT_BORN), uint(bitCount(bits)));
}
