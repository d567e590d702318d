#version 460
#extension GL_GOOGLE_include_directive : require
// What the particles in front left of their step goes on into those they bared, so that the retreat does not
// depend on the step. A particle keeps a sliver: it is counted out when it is at the surface.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
READ_U(1, start)
READ_F(2, erodibility)
READ_U(3, exposed)
READ_F(4, unspent)
WRITE_F(5, viability)
PARAMS(voxel_params)
#include "particles/voxel.glsl"

float left_at(ivec3 v)
{
    float most = 0.0;
    if (!voxel_inside(v))
        return most;
    uint c = voxel_index(v), end = LOAD_U(start, c + 1u);
    for (uint j = LOAD_U(start, c); j < end; j++)
        most = max(most, LOAD_F(unspent, j));
    return most;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n || LOAD_U(exposed, i) != 0u)
        return;
    ivec3 v = voxel_of(LOAD_V(position, i).xyz);
    float most = max(max(max(left_at(v + ivec3(1, 0, 0)), left_at(v - ivec3(1, 0, 0))),
                         max(left_at(v + ivec3(0, 1, 0)), left_at(v - ivec3(0, 1, 0)))),
                     max(left_at(v + ivec3(0, 0, 1)), left_at(v - ivec3(0, 0, 1))));
    if (most > 0.0)
        AT(viability, i) = max(AT(viability, i) - LOAD_F(erodibility, i) * most, 1e-4);
}
