#version 460
#extension GL_GOOGLE_include_directive : require
// Per moving node: search direction p = z + beta p, with z from the multigrid cycle.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_F(1, scalars)
READ_V(2, z)
READ_V(3, p_before)
WRITE_V(4, p)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(list, i);
    AT(p, node) = vec4(LOAD_V(z, node).xyz + LOAD_F(scalars, CG_BETA) * LOAD_V(p_before, node).xyz, 0.0);
}
