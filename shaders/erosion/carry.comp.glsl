#version 460
#extension GL_GOOGLE_include_directive : require
// What was left of the step when a particle was gone, its neighbours weather on through the faces it bared,
// so that the retreat does not depend on the step. A particle keeps a sliver: it is counted out when it is at
// the surface.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
READ_V(1, normal)
READ_U(2, start)
READ_F(3, erodibility)
READ_F(4, unspent)
WRITE_F(5, viability)
PARAMS(voxel_params)
#include "particles/voxel.glsl"

// The step that comes through the face towards v, along an axis.
float through(ivec3 v, int axis)
{
    float sum = 0.0;
    if (!voxel_inside(v))
        return sum;
    uint c = voxel_index(v), end = LOAD_U(start, c + 1u);
    for (uint j = LOAD_U(start, c); j < end; j++) {
        float left = LOAD_F(unspent, j);
        if (left > 0.0)
            sum += left * abs(LOAD_V(normal, j)[axis]);
    }
    return sum;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n || AT(viability, i) <= 0.0)
        return;
    ivec3 v = voxel_of(LOAD_V(position, i).xyz);
    float step = through(v + ivec3(1, 0, 0), 0) + through(v - ivec3(1, 0, 0), 0) + through(v + ivec3(0, 1, 0), 1) +
                 through(v - ivec3(0, 1, 0), 1) + through(v + ivec3(0, 0, 1), 2) + through(v - ivec3(0, 0, 1), 2);
    if (step > 0.0)
        AT(viability, i) = max(AT(viability, i) - LOAD_F(erodibility, i) * step, 1e-4);
}
