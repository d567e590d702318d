#version 460
#extension GL_GOOGLE_include_directive : require
// Per brick: the bounding box of its samples with any rock, three bits per coordinate and EXTENT_ANY (0: none),
// and that of its samples that are not all rock. The voxels (k.nx, k.ny, k.nz) begin at the field's sample
// k.margin.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
READ_F(1, fill)
WRITE_U(2, rock)
WRITE_U(3, bare)
PARAMS(field_params)
#include "field/lattice.glsl"
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/fill.glsl"

uint extent(ivec3 low, ivec3 high)
{
    return high.x < 0 ? 0u
                      : EXTENT_ANY | uint(low.x | (low.y << 3) | (low.z << 6) | (high.x << 9) | (high.y << 12) |
                                          (high.z << 15));
}

// Whether any of the words that the row of eight samples from this voxel is in has bits set.
bool row_holds(ivec3 v)
{
    if (any(lessThan(v.yz, ivec2(0))) || any(greaterThanEqual(v.yz, ivec2(k.ny, k.nz))))
        return false;
    int last = min(v.x + 7, int(k.nx) - 1);
    if (last < 0 || v.x >= int(k.nx))
        return false;
    uint a = HELD_STRIDE * voxel_word(ivec3(max(v.x, 0), v.yz)), b = HELD_STRIDE * voxel_word(ivec3(last, v.yz));
    return (LOAD_U(words, a) | LOAD_U(words, a + 2u) | LOAD_U(words, b) | LOAD_U(words, b + 2u)) != 0u;
}

void main()
{
    uint brick = THREAD;
    if (brick >= k.n)
        return;
    ivec3 first = brick_first(brick) - int(k.margin);
    ivec3 rock_low = ivec3(8), rock_high = ivec3(-1), bare_low = ivec3(8), bare_high = ivec3(-1);
    // Rock continues beyond walls, so samples beyond them must be read, too.
    bool holds = k.walls != 0u;
    for (int row = 0; row < 64 && !holds; row++)
        holds = row_holds(first + ivec3(0, row & 7, row >> 3));
    if (!holds) {
        bare_low = ivec3(0);
        bare_high = ivec3(7);
    }
    int rows = holds ? 8 : 0;
    for (int z = 0; z < rows; z++)
        for (int y = 0; y < 8; y++)
            for (int x = 0; x < 8; x++) {
                ivec3 c = ivec3(x, y, z);
                float share = fill_at(first + c);
                if (share > 0.0) {
                    rock_low = min(rock_low, c);
                    rock_high = max(rock_high, c);
                }
                if (share < 1.0 || !voxel_inside(first + c)) { // at walls the field is cut off (field/cut)
                    bare_low = min(bare_low, c);
                    bare_high = max(bare_high, c);
                }
            }
    AT(rock, brick) = extent(rock_low, rock_high);
    AT(bare, brick) = extent(bare_low, bare_high);
}
