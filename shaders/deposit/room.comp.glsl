#version 460
#extension GL_GOOGLE_include_directive : require
// How many crumbs may land in each cell of the ground before it is steeper than the angle of repose, by the
// slope half way through the last one's landing; 0 where it is unstable.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, bits)
WRITE_U(2, room)
PARAMS(deposit_params)
#include "particles/voxel.glsl"
#include "deposit/grid.glsl"
#include "deposit/column.glsl"
#include "deposit/slope.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint c = LOAD_U(list, i), n = 0u;
    ivec3 base = cell_base(cell_at(c));
    vec2 d = downhill(base, cell_top(base));
    while (n < DEPOSIT_ROOM && slope_with(d, float(n) + 0.5) <= k.repose)
        n++;
    AT(room, c) = n;
}
