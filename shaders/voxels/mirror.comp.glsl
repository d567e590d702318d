#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of the domain's slabs: fills the bits of the margin with the domain's mirror image behind walls, in
// both sets (gone, rock). Between rows is one word of margin, the first half of which follows the row's end and
// the second precedes the next row.
#include "shared/buffers.glsl"
#include "shared/params.h"

WRITE_U(0, bits)
PARAMS(voxels_params)
#include "voxels/grid.glsl"

// The coordinate in 0..n - 1 whose image is at `at`; -1 beyond an open side.
int seen(int at, uint n, uint wall_min, uint wall_max)
{
    int there = at;
    if (at < 0)
        there = (k.walls & wall_min) != 0u ? -1 - at : -1;
    else if (at >= int(n))
        there = (k.walls & wall_max) != 0u ? 2 * int(n) - 1 - at : -1;
    return there < int(n) ? there : -1;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint w = word_number(i), z = divide(i, k.slab, k.per_slab), in_slab = i - z * k.slab;
    uint row = divide(in_slab, k.row, k.per_row), word = in_slab - row * k.row;
    int y = int(row) - int(k.margin);
    uint own = domain_bits(word, row), gone = AT(bits, w) & own, rock = AT(bits, k.words + w) & own;
    for (int b = 0; b < 32; b++) {
        int x = int(32u * word) + b, line = y;
        uint level = z;
        if ((own >> b & 1u) != 0u)
            continue;
        if (word + 1u == k.row && b >= 16) { // before the next row
            x = b - 32;
            line++;
            if (row + 1u == k.rows) {
                line = -int(k.margin);
                level++;
            }
        }
        x = seen(x, k.nx, WALL_X_MIN, WALL_X_MAX);
        line = seen(line, k.ny, WALL_Y_MIN, WALL_Y_MAX);
        if (x < 0 || line < 0 || level == k.nz)
            continue;
        uint from = word_number(level * k.slab + (uint(line) + k.margin) * k.row + (uint(x) >> 5)), at = uint(x) & 31u;
        gone |= (AT(bits, from) >> at & 1u) << b;
        rock |= (AT(bits, k.words + from) >> at & 1u) << b;
    }
    AT(bits, w) = gone;
    AT(bits, k.words + w) = rock;
}
