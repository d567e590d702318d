#version 460
#extension GL_GOOGLE_include_directive : require
// q = K p, and p . q node by node, for the solver's step length.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, u)
READ_F(2, fill)
WRITE_V(3, q)
WRITE_F(4, product)
PARAMS(stress_params)
#include "stress/grid.glsl"
#include "stress/apply.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(list, i);
    vec3 force = apply_stiffness(node_of(node)).xyz;
    AT(q, i) = vec4(force, 0.0);
    AT(product, i) = dot(force, LOAD_V(u, node).xyz);
}
