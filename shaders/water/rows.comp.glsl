#version 460
#extension GL_GOOGLE_include_directive : require
// Which of 32 cells of a row along x have particles, as bits: memory is read in its own order.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, start)
WRITE_U(1, rows)
PARAMS(water_params)
#include "water/voxels.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint words = (k.cx + 31u) / 32u, x = i % words * 32u, row = i / words;
    uvec3 low, high;
    cell_voxels(uvec3(x, row % k.cy, row / k.cy), low, high);
    uvec4 line = uvec4(low.z * k.vy + low.y, low.z * k.vy + high.y - 1u, (high.z - 1u) * k.vy + low.y,
                       (high.z - 1u) * k.vy + high.y - 1u) * k.vx;
    uvec4 before = uvec4(LOAD_U(start, line.x + low.x), LOAD_U(start, line.y + low.x), LOAD_U(start, line.z + low.x),
                         LOAD_U(start, line.w + low.x));
    uint bits = 0u;
    for (uint b = 0u; b < 32u && x + b < k.cx; b++) {
        uint end = min(2u * (x + b) + 2u - k.sx, k.vx);
        uvec4 after = uvec4(LOAD_U(start, line.x + end), LOAD_U(start, line.y + end), LOAD_U(start, line.z + end),
                            LOAD_U(start, line.w + end));
        bits |= any(notEqual(before, after)) ? 1u << b : 0u;
        before = after;
    }
    AT(rows, i) = bits;
}
