// Deep voxels hang together in runs along x: runs are numbered in the order of all voxels, and each is a node of blocks, behind the
// held voxels. `first` has how many runs begin before each word of bits. Needs READ_U(words), and for nodes READ_U(first) and
// k.slots, the number of held voxels; and particles/held.glsl.

// Which bits of a word begin a run, the bit before its first one being 1 or 0.
uint run_starts(uint bits, uint before)
{
    return bits & ~(bits << 1 | before);
}

// Of the row of word i, the last bit of the word before.
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
