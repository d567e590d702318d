#version 460
#extension GL_GOOGLE_include_directive : require
// Per slot, before a run: keeps the air that is still outside the rock and removes the boundary particles of
// the last run. Slots from `first` on are empty.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
WRITE_V(1, velocity)
READ_U(2, words)
WRITE_U(3, key)
PARAMS(flow_params)
#include "wind/flow.glsl"
#include "wind/rock.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    AT(key, i) = flow_dead();
    if (i >= k.first)
        return;
    vec3 x = LOAD_V(position, i).xyz;
    if (AT(velocity, i).w > FLOW_SKIN || flow_in_rock(x))
        return;
    float kind = flow_kind(x);
    vec3 v = kind == FLOW_SKIN ? vec3(k.wind_x, k.wind_y, 0.0) : AT(velocity, i).xyz;
    AT(velocity, i) = vec4(v, kind);
    AT(key, i) = flow_index(flow_cell(x));
}
