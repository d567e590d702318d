#version 460
#extension GL_GOOGLE_include_directive : require
// Per column: rain on its highest span, in equal units for each column of voxels.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, occupied)
READ_U(1, floors)
READ_U(2, first)
WRITE_U(3, rain)
PARAMS(water_params)
#include "water/columns.glsl"
#include "water/voxels.glsl"

void main()
{
    uint column = THREAD;
    if (column >= k.n)
        return;
    uvec3 low, high;
    cell_voxels(uvec3(column % k.cx, column / k.cx, 0u), low, high);
    AT(rain, node_at(column, k.cz - 1u)) = k.rain * (high.x - low.x) * (high.y - low.y);
}
