#version 460
#extension GL_GOOGLE_include_directive : require
// Per boundary particle: its volume V = 0.7 / sum W over boundary particles (Akinci et al. 2012). The constant
// makes V = 1 in a flat layer of spacing 1.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, start)
READ_V(1, position)
READ_V(2, velocity)
WRITE_V(3, to_position)
PARAMS(flow_params)
#include "wind/flow.glsl"
#include "wind/cells.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n || i >= LOAD_U(start, flow_dead()))
        return;
    vec4 x = LOAD_V(position, i);
    float sum = 0.0;
    if (LOAD_V(velocity, i).w > FLOW_SKIN) {
        FLOW_EACH(x.xyz, if (LOAD_V(velocity, j).w > FLOW_SKIN)
            sum += flow_kernel(length(LOAD_V(position, j).xyz - x.xyz));)
        x.w = 0.7 / sum;
    }
    AT(to_position, i) = x;
}
