#version 460
#extension GL_GOOGLE_include_directive : require
// Per moving node: u += alpha p, r -= alpha q, and the node's term of r.z for Jacobi's z = r / diagonal.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_F(1, scalars)
READ_V(2, p)
READ_V(3, q)
READ_V(4, u_before)
READ_V(5, r_before)
WRITE_V(6, u)
WRITE_V(7, r)
WRITE_F(8, product)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(list, i);
    float alpha = LOAD_F(scalars, CG_ALPHA);
    vec4 residual = LOAD_V(r_before, i);
    residual.xyz -= alpha * LOAD_V(q, i).xyz;
    AT(u, node) = vec4(LOAD_V(u_before, node).xyz + alpha * LOAD_V(p, node).xyz, 0.0);
    AT(r, i) = residual;
    AT(product, i) = dot(residual.xyz, residual.xyz) * residual.w;
}
