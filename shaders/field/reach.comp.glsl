#version 460
#extension GL_GOOGLE_include_directive : require
// Where in each brick there is rock: the corners of the box of its samples that are not 0, three bits a number, and EXTENT_ANY; 0
// where there is none. The voxels, k.nx by k.ny by k.nz, begin at the field's sample k.margin.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
READ_F(1, fill)
WRITE_U(2, extent)
PARAMS(field_params)
#include "field/lattice.glsl"
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/fill.glsl"

uint extent_of(uint brick)
{
    ivec3 first = brick_first(brick), low = ivec3(8), high = ivec3(-1);
    ivec3 from = max(first - int(k.margin), ivec3(0)), to = min(first - int(k.margin) + 7, ivec3(k.nx, k.ny, k.nz) - 1);
    for (int z = from.z; z <= to.z; z++)
        for (int y = from.y; y <= to.y; y++)
            for (int x = from.x; x <= to.x; x++)
                if (fill_at(ivec3(x, y, z)) > 0.0) {
                    ivec3 c = ivec3(x, y, z) + int(k.margin) - first;
                    low = min(low, c);
                    high = max(high, c);
                }
    return high.x < 0 ? 0u
                      : EXTENT_ANY | uint(low.x | (low.y << 3) | (low.z << 6) | (high.x << 9) | (high.y << 12) |
                                          (high.z << 15));
}

void main()
{
    uint brick = THREAD;
    if (brick < k.n)
        AT(extent, brick) = extent_of(brick);
}
