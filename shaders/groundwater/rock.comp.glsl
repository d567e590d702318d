#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of bits: voxels that are rock: deep ones, and those with a particle that is neither a deposit nor
// falling.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
READ_U(1, start)
READ_U(2, phase)
WRITE_U(3, rock)
PARAMS(voxel_params)
#include "particles/bits.glsl"
#include "particles/held.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint bits = deep_word(i), held = LOAD_U(words, HELD_STRIDE * i), slot = LOAD_U(words, HELD_STRIDE * i + 1u);
    for (; held != 0u; held &= held - 1u, slot++)
        for (uint p = LOAD_U(start, slot); p < LOAD_U(start, slot + 1u); p++)
            if (LOAD_U(phase, p) == PHASE_ROCK)
                bits |= held & (0u - held);
    AT(rock, i) = bits;
}
