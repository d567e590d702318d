#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of 32 levels of a column: occupied cells and floors of spans as bits, and the number of these floors
// (columns.glsl).
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, rows) // words of bits along x; for cells of one voxel those of particles/held.glsl
WRITE_U(1, occupied)
WRITE_U(2, floors)
WRITE_U(3, count)
PARAMS(water_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint x = i % k.cx, y = (i / k.cx) % k.cy, word = i / (k.cx * k.cy), bits = 0u, above = 0u;
    uint wide = (k.cx + 31u) / 32u, slab = wide * k.cy, levels = min(k.cz - 32u * word, 33u);
    uint at = 32u * word * slab + y * wide + (x >> 5u), stride = 1u;
    if (k.size == 1u) {
        stride = HELD_STRIDE;
        at = at * HELD_STRIDE + 2u;
    }
    for (uint l = 0u; l < levels; l++) {
        uint rock = LOAD_U(rows, at) >> (x & 31u) & 1u;
        if (l < 32u)
            bits |= rock << l;
        else
            above = rock << 31u;
        at += slab * stride;
    }
    uint bottoms = bits & ~(bits >> 1u | above);
    if (word == 0u && (bits & 1u) == 0u)
        bottoms |= 1u;
    uint to = (y * k.cx + x) * k.words + word;
    AT(occupied, to) = bits;
    AT(floors, to) = bottoms;
    AT(count, to) = uint(bitCount(bottoms));
}
