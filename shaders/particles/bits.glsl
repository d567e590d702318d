// Voxels as bits: 32 of a row along x to a word, rows in y and then z. Needs k.nx and k.ny, or HELD_NX and
// HELD_NY.

#ifndef HELD_NX
#define HELD_NX k.nx
#define HELD_NY k.ny
#endif

uint voxel_word(ivec3 v)
{
    return (uint(v.z) * HELD_NY + uint(v.y)) * ((HELD_NX + 31u) >> 5) + (uint(v.x) >> 5);
}

uint voxel_bit(ivec3 v)
{
    return 1u << (v.x & 31);
}

// The voxel of bit number i % 32 of word i / 32.
ivec3 voxel_at(uint i)
{
    uint across = (HELD_NX + 31u) >> 5, word = i >> 5;
    return ivec3(word % across * 32u + (i & 31u), word / across % HELD_NY, word / across / HELD_NY);
}
