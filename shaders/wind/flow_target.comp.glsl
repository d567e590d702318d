#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: the compression that the constant-density solve has to remove, (rho - 1) / dt + D rho, for the
// current velocities.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_V(2, velocity)
WRITE_V(3, of_step)
WRITE_F(4, pressure)
PARAMS(flow_params)
#include "wind/flow.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    vec4 step = AT(of_step, i);
    uint n = uint(step.w);
    vec3 x = LOAD_V(position, i).xyz, v = LOAD_V(velocity, i).xyz;
    float compression = 0.0;
    for (uint s = 0u; s < n; s++) {
        uint j = LOAD_U(list, flow_listed(i, s));
        vec4 other = LOAD_V(position, j);
        vec3 d = x - other.xyz;
        compression += other.w * dot(v - LOAD_V(velocity, j).xyz, flow_slope(d, sqrt(max(dot(d, d), 1e-12))));
    }
    AT(of_step, i).z = (step.x - 1.0) / k.dt + compression;
    AT(pressure, i) = k.warm * AT(pressure, i);
}
