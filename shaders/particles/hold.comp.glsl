#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of bits: the voxels to hold: those that have particles and, with k.around, those around occupied
// ones, but no deep ones, whose bits are here in place of the held ones' until now. Writes their bits and their
// number, 0 for the word after the last.
#include "shared/buffers.glsl"
#include "shared/params.h"

WRITE_U(0, words)
WRITE_U(1, count)
PARAMS(hold_params)
#include "particles/bits.glsl"

uint occupied(uint word)
{
    return AT(words, HELD_STRIDE * word + 2u);
}

// Bits of 32 voxels of a row or'ed with those of the voxels before and after them.
uint along(int x, uint y, uint z)
{
    int across = int((k.nx + 31u) >> 5);
    uint at = (z * k.ny + y) * uint(across) + uint(x), own = occupied(at);
    uint before = x > 0 ? occupied(at - 1u) >> 31 : 0u;
    uint behind = x + 1 < across ? occupied(at + 1u) << 31 : 0u;
    return own | own << 1 | own >> 1 | before | behind;
}

uint around(ivec3 v)
{
    uint sum = 0u;
    for (int z = max(v.z - 1, 0); z <= min(v.z + 1, int(k.nz) - 1); z++)
        for (int y = max(v.y - 1, 0); y <= min(v.y + 1, int(k.ny) - 1); y++)
            sum |= along(v.x >> 5, uint(y), uint(z));
    uint inside = k.nx - uint(v.x);
    return inside < 32u ? sum & ((1u << inside) - 1u) : sum;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint bits = 0u;
    if (i + 1u < k.n)
        bits = (k.around != 0u ? around(voxel_at(32u * i)) : occupied(i)) & ~AT(words, HELD_STRIDE * i);
    AT(words, HELD_STRIDE * i) = bits;
    AT(count, i) = uint(bitCount(bits));
}
