// Heights of columns, from their bits. Needs READ_U(bits), k.walls and particles/bits.glsl. Beyond walls lies the mirror image,
// the domain's open sides go on as they are, and below the ground all is solid.
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

// The floor of column (x, y) as one who stands on z comes to it: the first free voxel upwards if z is solid,
// else the lowest free one below; relative to z, -16 to 16.
int floor_near(int x, int y, int z)
{
    uint b = column_bits(x, y, z - 16);
    if ((b >> 16 & 1u) != 0u) {
        uint free = ~(b >> 16) & 0xffffu;
        return free == 0u ? 16 : findLSB(free);
    }
    return findMSB(b & 0xffffu) - 15;
}

// The lowest free voxel over the highest solid one of a cell's column, looked for from two voxels over the cell
// (base z) down; 28 below at most.
int floor_in(int x, int y, int z)
{
    return z + 4 - 31 + findMSB(column_bits(x, y, z + 4 - 32));
}
