#version 460
#extension GL_GOOGLE_include_directive : require
// A deposit on ground steeper than the angle at which deposits begin to slide, by the slope half way through its
// leaving, slides on: the one on the highest column of the cell becomes a crumb. That angle is larger than the
// one at which they come to rest, as it is for sand, so that what has landed does not slide at once; and what
// slides comes to rest lower.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, bits)
READ_U(2, start)
READ_U(3, phase)
WRITE_U(4, crumb)
WRITE_U(5, counts)
READ_U(6, words)
PARAMS(deposit_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"
#include "deposit/grid.glsl"
#include "deposit/column.glsl"
#include "deposit/slope.glsl"

// The deposit on top of a column of the cell, if it is higher than those before.
void look(ivec3 base, int x, int y, inout int highest, inout uint found)
{
    int z = floor_in(base.x + x, base.y + y, base.z) - 1;
    ivec3 v = ivec3(base.x + x, base.y + y, z);
    if (z <= highest || z < base.z || z > base.z + 1 || !voxel_inside(v))
        return;
    uvec2 in_voxel = voxel_particles(v);
    for (uint j = in_voxel.x; j < in_voxel.y; j++)
        if (LOAD_U(phase, j) == 1u && AT(crumb, j) == 0u) {
            highest = z;
            found = j;
        }
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 base = cell_base(cell_at(LOAD_U(list, i)));
    if (stable(slope_of(base, cell_top(base)), -0.5, k.repose + SLOPE_SLIDE))
        return;
    int highest = -1;
    uint found = 0xffffffffu;
    look(base, 0, 0, highest, found);
    look(base, 1, 0, highest, found);
    look(base, 0, 1, highest, found);
    look(base, 1, 1, highest, found);
    if (found != 0xffffffffu) {
        AT(crumb, found) = 1u;
        atomicAdd(AT(counts, COUNT_SLID), 1u);
    }
}
