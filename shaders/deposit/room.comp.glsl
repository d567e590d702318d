#version 460
#extension GL_GOOGLE_include_directive : require
// Per ground cell: how many fragments it accepts before its slope exceeds repose, measured when each is half
// landed. 0 where the ground is too steep or water would carry them on. A hollow always accepts one, since no
// path leads out of it.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, bits)
READ_U(2, tag)
WRITE_U(3, room)
PARAMS(deposit_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "deposit/grid.glsl"
#include "deposit/column.glsl"
#include "deposit/floors.glsl"
#include "deposit/slope.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint c = LOAD_U(list, i), n = 0u;
    ivec3 at = cell_at(c), base = cell_base(at);
    uint most = min(DEPOSIT_ROOM, free_voxels(base, floors(at, base)));
    int top = cell_top(base);
    slope s = slope_of(base, top);
    if ((LOAD_U(tag, c) & WATER_SWEPT) != 0u) {
        AT(room, c) = 0u;
        return;
    }
    while (n < most && stable(s, float(n) + 0.5, k.repose))
        n++;
    AT(room, c) = n == 0u && most > 0u && drops(base, top) == uvec4(0u) ? 1u : n;
}
