#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of voxels: the active ones, rock with air in a small ball around it, 32 voxels at a time. Each row
// of the ball is a run of at most 4 voxels to either side.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, bits)
READ_U(1, touched)
READ_U(2, rows)
WRITE_U(3, skin)
WRITE_U(4, place)
PARAMS(voxels_params)
#include "voxels/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uvec3 place_of = word_place(i);
    uint w = word_number(i), at = k.words + w, own = LOAD_U(bits, at) & domain_bits(place_of.x, place_of.y);
    bool touch = LOAD_U(touched, brick_of(place_of)) != 0u;
    uint near = 0u, n = touch && own != 0u ? k.skin_rows : 0u;
    for (uint r = 0u; r < n; r++) {
        uint entry = k.skin_first + 2u * r;
        uint there = at + LOAD_U(rows, entry), run = LOAD_U(rows, entry + 1u);
        uint before = ~LOAD_U(bits, there - 1u), here = ~LOAD_U(bits, there);
        uint after = ~LOAD_U(bits, there + 1u);
        near |= here;
        if (run >= 1u)
            near |= here << 1 | before >> 31 | here >> 1 | after << 31;
        if (run >= 2u)
            near |= here << 2 | before >> 30 | here >> 2 | after << 30;
        if (run >= 3u)
            near |= here << 3 | before >> 29 | here >> 3 | after << 29;
        if (run >= 4u)
            near |= here << 4 | before >> 28 | here >> 4 | after << 28;
    }
    uint exposed = touch ? own & near : AT(skin, w);
    AT(skin, w) = exposed;
    AT(place, i) = uint(bitCount(exposed));
}
