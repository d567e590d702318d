// Sparse storage of voxels. Only some voxels are held, that is, have items in buffers of voxels. `words` has
// HELD_STRIDE words for each word of bits: the bits of held voxels, the number of held voxels before them, and
// the bits of occupied ones; and HELD_STRIDE more at the end. A voxel that is occupied but not held is deep:
// full of rock, without a particle. A held voxel's item is its slot, its rank among the held ones; slots ascend
// as voxels do. Needs READ_U(words) and particles/bits.glsl.

const uint NOT_HELD = 0xffffffffu;

// Number of held voxels before this one, which may be one past the end of its row.
uint voxel_rank(ivec3 v)
{
    uint w = HELD_STRIDE * voxel_word(v);
    return LOAD_U(words, w + 1u) + uint(bitCount(LOAD_U(words, w) & (voxel_bit(v) - 1u)));
}

uint voxel_slot(ivec3 v)
{
    uint w = HELD_STRIDE * voxel_word(v), bits = LOAD_U(words, w), own = voxel_bit(v);
    return (bits & own) == 0u ? NOT_HELD : LOAD_U(words, w + 1u) + uint(bitCount(bits & (own - 1u)));
}

// Bits of the deep voxels of a word.
uint deep_word(uint word)
{
    return LOAD_U(words, HELD_STRIDE * word + 2u) & ~LOAD_U(words, HELD_STRIDE * word);
}

// Whether a voxel of the domain is deep: full of rock, without a particle so far.
bool voxel_deep(ivec3 v)
{
    return (deep_word(voxel_word(v)) & voxel_bit(v)) != 0u;
}
