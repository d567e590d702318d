#version 460
#extension GL_GOOGLE_include_directive : require
// Per moving node: q = K p, and the node's term of p.q for the step length alpha. `u` is bound to p.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, run)
READ_U(2, table)
READ_V(3, u)
READ_F(4, fill)
WRITE_V(5, q)
WRITE_F(6, product)
PARAMS(stress_params)
#include "stress/grid.glsl"
#include "stress/rows.glsl"
#include "stress/apply.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(list, i);
    vec3 force = apply_stiffness(node).xyz;
    AT(q, i) = vec4(force, 0.0);
    AT(product, i) = dot(force, LOAD_V(u, node).xyz);
}
