#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle of free air: its neighbour list and what the step needs from it: density rho, factor of the
// pressure solves 1 / (|sum V grad W|^2 + sum |V grad W|^2), rate of compression D rho (Bender and Koschier
// 2015), velocity change by viscosity (Becker et al. 2009), and grad rho for the drift. Zero for other
// particles.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, start)
READ_V(1, position)
READ_V(2, velocity)
WRITE_U(3, list)
WRITE_V(4, of_step)
WRITE_V(5, viscous)
WRITE_V(6, crowd)
WRITE_F(7, pressure)
PARAMS(flow_params)
#include "wind/flow.glsl"
#include "wind/cells.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    if (i >= LOAD_U(start, flow_dead())) {
        AT(of_step, i) = vec4(0.0);
        return;
    }
    vec3 x = LOAD_V(position, i).xyz;
    vec4 v = LOAD_V(velocity, i);
    uint n = 0u;
    vec4 step = vec4(0.0);
    vec3 slopes = vec3(0.0), drag = vec3(0.0);
    if (v.w == FLOW_AIR) {
        float density = flow_kernel(0.0), squares = 0.0, compression = 0.0;
        FLOW_EACH(x,
            vec4 other = LOAD_V(position, j);
            vec3 d = x - other.xyz;
            float r2 = dot(d, d);
            if (r2 < FLOW_SUPPORT * FLOW_SUPPORT && j != i && n < FLOW_NEIGHBOURS) {
                float r = sqrt(max(r2, 1e-12));
                vec4 u = LOAD_V(velocity, j);
                vec3 slope = other.w * flow_slope(d, r);
                float along = dot(v.xyz - u.xyz, d);
                density += other.w * flow_kernel(r);
                slopes += slope;
                squares += u.w == FLOW_AIR ? dot(slope, slope) : 0.0;
                compression += dot(v.xyz - u.xyz, slope);
                drag += u.w == FLOW_GROUND ? vec3(0.0) : along / (r2 + 0.01 * FLOW_SUPPORT * FLOW_SUPPORT) * slope;
                AT(list, flow_listed(i, n)) = j;
                n++;
            })
        float diagonal = dot(slopes, slopes) + squares;
        step = vec4(density, diagonal > 1e-6 ? 1.0 / diagonal : 0.0, compression, float(n));
    }
    AT(of_step, i) = step;
    AT(viscous, i) = vec4(10.0 * k.viscosity * k.dt * drag, 0.0);
    AT(crowd, i) = vec4(slopes, 0.0);
    AT(pressure, i) = v.w == FLOW_AIR ? k.warm * AT(pressure, i) : 0.0;
}
