#version 460
#extension GL_GOOGLE_include_directive : require
// Per moving node: search direction p = z + beta p, with Jacobi's z = r / diagonal.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_F(1, scalars)
READ_V(2, r)
READ_V(3, p_before)
WRITE_V(4, p)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(list, i);
    vec4 residual = LOAD_V(r, i);
    AT(p, node) = vec4(residual.w * residual.xyz + LOAD_F(scalars, CG_BETA) * LOAD_V(p_before, node).xyz, 0.0);
}
