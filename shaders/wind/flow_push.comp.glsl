#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: velocity change by pressure, a_i = -sum_j V_j (p_i + p_j) grad W_ij. Boundary particles have p
// = 0.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, of_step)
READ_U(1, list)
READ_V(2, position)
READ_F(3, pressure)
WRITE_V(4, push)
PARAMS(flow_params)
#include "wind/flow.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint n = uint(LOAD_V(of_step, i).w);
    vec3 x = LOAD_V(position, i).xyz, sum = vec3(0.0);
    float own = LOAD_F(pressure, i);
    for (uint s = 0u; s < n; s++) {
        uint j = LOAD_U(list, flow_listed(i, s));
        vec4 other = LOAD_V(position, j);
        vec3 d = x - other.xyz;
        sum -= other.w * (own + LOAD_F(pressure, j)) * flow_slope(d, sqrt(max(dot(d, d), 1e-12)));
    }
    AT(push, i) = vec4(sum, 0.0);
}
