#version 460
#extension GL_GOOGLE_include_directive : require
// Per loose particle: its block, that of its voxel or the lowest across a face; and counts the loose particles
// of each block.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
READ_U(1, solid)
READ_U(2, root)
READ_U(3, flags)
READ_U(4, words)
WRITE_U(5, block)
WRITE_U(6, size)
PARAMS(crumble_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"

uint block_at(ivec3 v)
{
    uint s = voxel_inside(v) ? voxel_slot(v) : NOT_HELD;
    return s != NOT_HELD && LOAD_U(solid, s) != 0u ? LOAD_U(root, s) : NOT_HELD;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n || LOAD_U(flags, i) == 0u)
        return;
    ivec3 v = voxel_of(LOAD_V(position, i).xyz);
    uint own = block_at(v);
    if (own == NOT_HELD)
        for (int a = 0; a < 3; a++) {
            ivec3 step = ivec3(a == 0, a == 1, a == 2);
            own = min(own, min(block_at(v - step), block_at(v + step)));
        }
    AT(block, i) = own;
    if (own != NOT_HELD)
        atomicAdd(AT(size, own), 1u);
}
