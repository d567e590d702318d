#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: one Jacobi iteration with omega = 1/2, p += (s + D a) factor / 2, where s is the compression to
// remove and D a that of the pressure's velocity change. Pressure is clamped to >= 0 unless the density is at
// least `full`, where air may also pull.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, of_step)
READ_U(1, list)
READ_V(2, position)
READ_V(3, push)
WRITE_F(4, pressure)
PARAMS(flow_params)
#include "wind/flow.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    vec4 step = LOAD_V(of_step, i);
    uint n = uint(step.w);
    vec3 x = LOAD_V(position, i).xyz, own = LOAD_V(push, i).xyz;
    float left = step.z;
    for (uint s = 0u; s < n; s++) {
        uint j = LOAD_U(list, flow_listed(i, s));
        vec4 other = LOAD_V(position, j);
        vec3 d = x - other.xyz;
        left += other.w * dot(own - LOAD_V(push, j).xyz, flow_slope(d, sqrt(max(dot(d, d), 1e-12))));
    }
    float p = AT(pressure, i) + 0.5 * step.y * left;
    AT(pressure, i) = step.x >= k.full ? p : max(p, 0.0);
}
