#version 460
#extension GL_GOOGLE_include_directive : require
// Per node: number of bodies that reach it, and 1 if that is more than one.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, slot)
READ_U(2, many)
READ_U(3, part_body)
WRITE_U(4, count)
WRITE_U(5, flags)
PARAMS(mpm_params)
#include "mpm/bodies.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint bodies[MPM_BODIES], n = bodies_at(LOAD_U(list, i), bodies);
    AT(count, i) = n;
    AT(flags, i) = n > 1u ? 1u : 0u;
}
