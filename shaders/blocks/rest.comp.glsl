#version 460
#extension GL_GOOGLE_include_directive : require
// Per held voxel: solid, or an empty voxel of a vertical gap of up to two below rubble. Such gaps count as
// solid, since the surface field cannot close them at this resolution and rubble rests across them.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
READ_U(1, start)
READ_U(2, list)
READ_U(3, solid)
READ_U(4, phase)
WRITE_U(5, bridged)
PARAMS(voxel_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"

bool solid_at(ivec3 v)
{
    uint s = voxel_inside(v) ? voxel_slot(v) : NOT_HELD;
    return v.z < 0 || (s != NOT_HELD && LOAD_U(solid, s) != 0u);
}

bool rubble_at(ivec3 v)
{
    uvec2 in_voxel = voxel_inside(v) ? voxel_particles(v) : uvec2(0u);
    return in_voxel.x < in_voxel.y && LOAD_U(phase, in_voxel.x) == PHASE_FALLING;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 v = voxel_at(LOAD_U(list, i));
    const ivec3 up = ivec3(0, 0, 1);
    bool rests = LOAD_U(solid, i) != 0u;
    if (!rests) {
        int above = solid_at(v + up) ? 1 : solid_at(v + 2 * up) ? 2 : 3;
        int below = solid_at(v - up) ? 1 : solid_at(v - 2 * up) ? 2 : 3;
        rests = above + below <= 3 && rubble_at(v + above * up);
    }
    AT(bridged, i) = rests ? 1u : 0u;
}
