// Column heights from the bits. Needs READ_U(bits), k.walls and particles/bits.glsl. Beyond walls the ground is
// mirrored, beyond open sides it continues level, below z = 0 everything is solid.
#include "particles/sides.glsl"

uint column_word(int x, int y, int w)
{
    if (w < 0)
        return 0xffffffffu;
    return w >= int(k.words) ? 0u : LOAD_U(bits, (uint(w) * k.ny + uint(y)) * k.nx + uint(x));
}

// The 32 voxels from z up: bit 0 is z.
uint column_bits(int x, int y, int z)
{
    if (k.walls != 0u) {
        ivec3 seen = side_voxel(ivec3(x, y, 0));
        x = seen.x;
        y = seen.y;
    }
    x = clamp(x, 0, int(k.nx) - 1);
    y = clamp(y, 0, int(k.ny) - 1);
    int w = z >> 5, s = z & 31;
    uint low = column_word(x, y, w);
    return s == 0 ? low : (low >> s) | (column_word(x, y, w + 1) << (32 - s));
}

// The floor of column (x, y) seen from height z: the first free voxel above if z is solid, else the lowest free one below.
// Relative to z, -16 to 16.
int floor_near(int x, int y, int z)
{
    uint b = column_bits(x, y, z - 16);
    if ((b >> 16 & 1u) != 0u) {
        uint free = ~(b >> 16) & 0xffffu;
        return free == 0u ? 16 : findLSB(free);
    }
    return findMSB(b & 0xffffu) - 15;
}

// The free voxel on top of a cell's column, searched from two voxels above the cell (base z) downwards, at most 28 below.
int floor_in(int x, int y, int z)
{
    return z + 4 - 31 + findMSB(column_bits(x, y, z + 4 - 32));
}
