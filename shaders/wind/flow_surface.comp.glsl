#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle of the rock: adds 1, its position within its cell of the box, and its normal to the
// cell's integer sums.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_V(2, normal)
WRITE_U(3, sums)
PARAMS(flow_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    vec3 x = (LOAD_V(position, self).xyz - vec3(k.origin_x, k.origin_y, 0.0)) / k.spacing;
    ivec3 cell = clamp(ivec3(floor(x)), ivec3(0), ivec3(k.bx, k.by, k.bz) - 1);
    uint at = 8u * ((uint(cell.z) * k.by + uint(cell.y)) * k.bx + uint(cell.x));
    uvec3 part = uvec3((x - vec3(cell)) * FLOW_FIXED);
    ivec3 n = ivec3(round(LOAD_V(normal, self).xyz * FLOW_FIXED));
    atomicAdd(AT(sums, at), 1u);
    for (uint a = 0u; a < 3u; a++) {
        atomicAdd(AT(sums, at + 1u + a), part[a]);
        atomicAdd(AT(sums, at + 4u + a), uint(n[a]));
    }
}
