#version 460
#extension GL_GOOGLE_include_directive : require
// Cells in which water pulls too hard for crumbs to come to rest, by any particle of their surface.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_V(2, normal)
READ_U(3, occupied)
READ_U(4, floors)
READ_U(5, first)
READ_U(6, altitude)
READ_U(7, rain)
READ_U(8, spring)
WRITE_U(9, tag)
PARAMS(water_surface_params)
#include "water/columns.glsl"
#include "water/discharge.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    vec3 n = LOAD_V(normal, self).xyz, x = LOAD_V(position, self).xyz;
    if (n.z <= 0.0)
        return;
    float q = discharge_at(x), slope = min(length(n.xy) / n.z, k.steepest);
    if (q <= 0.0 || k.shear * pow(q, 0.6) * pow(slope, 0.7) <= k.threshold)
        return;
    uvec3 at = uvec3(clamp(ivec3(floor(x / k.cell + 0.5 * vec3(k.sx, k.sy, k.sz))), ivec3(0), ivec3(k.cx, k.cy, k.cz) - 1));
    atomicOr(AT(tag, (at.z * k.cy + at.y) * k.cx + at.x), WATER_SWEPT);
}
