#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: x += dt v - dt gain grad(density), and the key of its cell, or none if it has left the box or
// entered rock. The second term (particle shifting, Lind et al. 2012) drifts air towards lower density, so that
// it fills wakes. Speeds are clamped to half a spacing per step.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, start)
READ_V(1, crowd)
READ_U(2, words)
WRITE_V(3, position)
WRITE_V(4, velocity)
WRITE_U(5, key)
PARAMS(flow_params)
#include "wind/flow.glsl"
#include "wind/rock.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    AT(key, i) = flow_dead();
    if (i >= LOAD_U(start, flow_dead()))
        return;
    vec4 x = AT(position, i), v = AT(velocity, i);
    if (v.w <= FLOW_SKIN) {
        float fast = length(v.xyz) * k.dt;
        if (v.w == FLOW_SKIN)
            v.xyz = vec3(k.wind_x, k.wind_y, 0.0);
        else if (fast > 0.5)
            v.xyz *= 0.5 / fast;
        x.xyz += k.dt * v.xyz - k.dt * k.gain * LOAD_V(crowd, i).xyz;
        x.z = max(x.z, 0.0);
        v.w = flow_kind(x.xyz);
        if (!flow_inside(x.xyz) || flow_in_rock(x.xyz))
            return;
        AT(position, i) = x;
        AT(velocity, i) = v;
    }
    AT(key, i) = flow_index(flow_cell(x.xyz));
}
