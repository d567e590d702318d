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
READ_U(6, shares)  // of the particles that are gone: by what
WRITE_U(7, spent) // quanta
WRITE_U(8, parts) // by what
READ_U(9, words)
PARAMS(voxel_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"
#include "erosion/budget.glsl"

// The step that comes through the face towards v, along an axis; and the parts that processes have in it.
vec3 through(ivec3 v, int axis)
{
    vec3 sum = vec3(0.0);
    if (!voxel_inside(v))
        return sum;
    uvec2 in_voxel = voxel_particles(v);
    for (uint j = in_voxel.x; j < in_voxel.y; j++) {
        float left = LOAD_F(unspent, j);
        if (left > 0.0)
            sum += left * abs(LOAD_V(normal, j)[axis]) * vec3(1.0, unpackUnorm2x16(LOAD_U(shares, j)));
    }
    return sum;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    float before = AT(viability, i);
    AT(spent, i) = 0u;
    if (before <= 0.0)
        return;
    ivec3 v = voxel_of(LOAD_V(position, i).xyz);
    vec3 step = through(v + ivec3(1, 0, 0), 0) + through(v - ivec3(1, 0, 0), 0) + through(v + ivec3(0, 1, 0), 1) +
                through(v - ivec3(0, 1, 0), 1) + through(v + ivec3(0, 0, 1), 2) + through(v - ivec3(0, 0, 1), 2);
    if (step.x > 0.0) {
        float after = max(before - LOAD_F(erodibility, i) * step.x, 1e-4);
        AT(viability, i) = after;
        AT(parts, i) = packUnorm2x16(step.yz / step.x);
        AT(spent, i) = quanta(before) - quanta(after);
    }
}
