#version 460
#extension GL_GOOGLE_include_directive : require
// Per active voxel: the number of air voxels in its bubble. A known count grows by what has just vanished in
// the bubble; for a newly active voxel the rock is counted. A bubble is a table of rows, each a run of at most
// 31 voxels: two words, shifted and masked, and a bit count. Rows come in fours, padded with empty ones.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, bits)
READ_U(2, touched)
READ_U(3, rows)
READ_U(4, bubbles)
READ_U(5, layer_of)
WRITE_U(6, state)
PARAMS(voxels_params)
#include "voxels/grid.glsl"
#include "voxels/layer.glsl"

// Number of bits set in one row of the bubble around voxel v.
uint run_bits(uint v, uint base, uint row)
{
    uint at = v + LOAD_U(rows, row), there = base + (at >> 5), shift = at & 31u;
    uint run = LOAD_U(bits, there) >> shift | LOAD_U(bits, there + 1u) << 1 << (31u - shift);
    return uint(bitCount(run & LOAD_U(rows, row + 1u)));
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint v = LOAD_U(list, i), known = AT(state, v);
    bool fresh = (known & 0xffffu) == VOXELS_UNKNOWN;
    uvec3 place = word_place((v >> 5) - word_number(0u));
    uint layer = layer_at(v);
    // first row, rows, voxels of the bubble
    uint row = LOAD_U(bubbles, 3u * layer), n = LOAD_U(bubbles, 3u * layer + 1u);
    uint end = row + 2u * (fresh || LOAD_U(touched, brick_of(place)) != 0u ? n : 0u);
    uint base = fresh ? k.words : 0u, sum = 0u;
    for (; row < end; row += 8u)
        sum += run_bits(v, base, row) + run_bits(v, base, row + 2u) + run_bits(v, base, row + 4u) +
               run_bits(v, base, row + 6u);
    uint air = fresh ? LOAD_U(bubbles, 3u * layer + 2u) - sum : (known & 0xffffu) + sum;
    AT(state, v) = (known & 0xffff0000u) | air;
}
