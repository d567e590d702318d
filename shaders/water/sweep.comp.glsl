#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle that is a floor: marks its fragments' cell (WATER_SWEPT) where water pulls harder than
// carry_Pa, so that none comes to rest there.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_U(2, occupied)
READ_U(3, floors)
READ_U(4, first)
READ_V(5, pull)
WRITE_U(6, tag)
PARAMS(water_surface_params)
#include "particles/voxel.glsl"
#include "water/columns.glsl"
#include "water/floor.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 v = voxel_of(LOAD_V(position, LOAD_U(list, i)).xyz);
    uint node = floor_at(v);
    if (node == NONE || LOAD_V(pull, node).x <= k.carry)
        return;
    uvec3 at = (uvec3(v) + uvec3(k.sx, k.sy, k.sz)) / k.size;
    atomicOr(AT(tag, (at.z * k.cy + at.y) * k.cx + at.x), WATER_SWEPT);
}
