#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of 32 cells of two voxels a side along x: which of them have particles, as bits. (For cells of one
// voxel such bits exist already.)
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
WRITE_U(1, rows)
PARAMS(water_params)
#include "water/voxels.glsl"

// Word `w` of the voxels' row that begins at word `row`; 0 beyond its ends.
uint word_of(uint row, int w, int across)
{
    return w >= 0 && w < across ? LOAD_U(words, HELD_STRIDE * (row + uint(w)) + 2u) : 0u;
}

// Bits 0, 2, 4, ... of a word, together.
uint even_bits(uint b)
{
    b &= 0x55555555u;
    b = (b | b >> 1) & 0x33333333u;
    b = (b | b >> 2) & 0x0f0f0f0fu;
    b = (b | b >> 4) & 0x00ff00ffu;
    return (b | b >> 8) & 0xffffu;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint wide = (k.cx + 31u) / 32u, x = i % wide * 32u, row = i / wide;
    int across = int((k.vx + 31u) >> 5), first = int(2u * x >> 5);
    uvec3 low, high;
    cell_voxels(uvec3(x, row % k.cy, row / k.cy), low, high);
    uvec3 bits = uvec3(0u); // the 96 voxels from word `first` - 1 on
    for (uint z = low.z; z < high.z; z++)
        for (uint y = low.y; y < high.y; y++) {
            uint line = (z * k.vy + y) * uint(across);
            bits |= uvec3(word_of(line, first - 1, across), word_of(line, first, across), word_of(line, first + 1, across));
        }
    if (k.sx != 0u)
        bits.yz = bits.yz << 1 | bits.xy >> 31;
    bits |= bits >> 1;
    AT(rows, i) = even_bits(bits.y) | even_bits(bits.z) << 16;
}
