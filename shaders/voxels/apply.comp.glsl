#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of voxels, second step of a cycle: clears the bits of voxels that vanished, marks their bricks and
// counts them.
#include "shared/buffers.glsl"
#include "shared/params.h"

WRITE_U(0, bits)
WRITE_U(1, gone_bricks)
WRITE_U(2, words)
PARAMS(voxels_params)
#include "voxels/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint w = word_number(i), gone = AT(bits, w);
    if (gone != 0u) {
        AT(bits, k.words + w) &= ~gone;
        AT(gone_bricks, brick_of(word_place(i))) = 1u;
        uvec3 place = word_place(i);
        atomicAdd(AT(words, VOXELS_GONE), uint(bitCount(gone & domain_bits(place.x, place.y))));
    }
}
