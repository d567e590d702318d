// Columns of cells as bits. Cell (x, y, z) is bit z % 32 of word (y cx + x) words + z / 32. `occupied`: it
// holds particles. `floors`: it is the lowest cell of a span, SURF, or EMPTY on the ground. A span of empty
// cells with its floor is a node; first[word] counts the nodes before the word's. Needs READ_U of the three,
// and k.

const uint NONE = 0xffffffffu;

bool is_occupied(uint column, uint z)
{
    return (LOAD_U(occupied, column * k.words + (z >> 5u)) >> (z & 31u) & 1u) != 0u;
}

// The span that a cell belongs to; NONE in solid rock.
uint node_at(uint column, uint z)
{
    uint word = column * k.words + (z >> 5u), own = LOAD_U(floors, word);
    if (((LOAD_U(occupied, word) & ~own) >> (z & 31u) & 1u) != 0u)
        return NONE;
    return LOAD_U(first, word) + uint(bitCount(own & 0xffffffffu >> (31u - (z & 31u)))) - 1u;
}
