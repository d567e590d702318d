// Positions of words and voxels in the bit sets. Needs PARAMS(voxels_params).

// a / b from the reciprocal of b: integer division is slow where it is not vectorised.
uint divide(uint a, uint b, float per_b)
{
    uint q = uint(float(a) * per_b);
    int rest = int(a - q * b);
    return rest < 0 ? q - 1u : rest >= int(b) ? q + 1u : q;
}

// Word `i` of the domain's slabs as (word in its row, row, slab), margins counted.
uvec3 word_place(uint i)
{
    uint z = divide(i, k.slab, k.per_slab), in_slab = i - z * k.slab;
    uint y = divide(in_slab, k.row, k.per_row);
    return uvec3(in_slab - y * k.row, y, z + k.margin);
}

// The bits of a word that are voxels of the domain, by its index in its row and the row's in its slab, margins counted.
uint domain_bits(uint word, uint row)
{
    if (row < k.margin || row >= k.margin + k.ny || 32u * word >= k.nx)
        return 0u;
    uint left = k.nx - 32u * word;
    return left < 32u ? (1u << left) - 1u : 0xffffffffu;
}

// Index of word i of the domain's slabs in a bit set, which begins with one word of margin.
uint word_number(uint i)
{
    return 1u + k.margin * k.slab + i;
}

// The slab of a voxel, the ground being below 0.
uint slab_of(uint voxel)
{
    return divide((voxel >> 5) - 1u, k.slab, k.per_slab) - k.margin;
}

uint brick_of(uvec3 word)
{
    return ((word.z / VOXELS_BRICK) * k.brick_rows + word.y / VOXELS_BRICK) * k.row + word.x;
}

// Voxel i of the domain, (z ny + y) nx + x, as its bit.
uint voxel_bit(uint x, uint y, uint z)
{
    return (1u + (z + k.margin) * k.slab + (y + k.margin) * k.row) * 32u + x;
}
