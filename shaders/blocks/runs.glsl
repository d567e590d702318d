// Runs of deep voxels along x as nodes of blocks, numbered in the order of all voxels behind the held voxels.
// `first` counts the runs before each word of bits. Needs READ_U(words), for nodes also READ_U(first) and
// k.slots (the number of held voxels), and particles/held.glsl.

// Bits of a word at which runs begin; `before` is the bit that precedes the word.
uint run_starts(uint bits, uint before)
{
    return bits & ~(bits << 1 | before);
}

// The last bit of the word before word i in its row; 0 at the row's start.
uint last_before(uint i)
{
    return i % ((HELD_NX + 31u) >> 5) > 0u ? deep_word(i - 1u) >> 31 : 0u;
}

uint own_starts(uint i)
{
    return run_starts(deep_word(i), last_before(i));
}

#ifndef NO_NODES
// The node of the deep voxel that is `bit` of word i.
uint run_node(uint i, uint bit)
{
    return k.slots + LOAD_U(first, i) + uint(bitCount(own_starts(i) & (bit | (bit - 1u)))) - 1u;
}
#endif
