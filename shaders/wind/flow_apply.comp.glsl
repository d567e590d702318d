#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: v += push, the velocity change by pressure, + gain times that by viscosity.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, push)
READ_V(1, viscous)
WRITE_V(2, velocity)
PARAMS(flow_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(velocity, i).xyz += LOAD_V(push, i).xyz + k.gain * LOAD_V(viscous, i).xyz;
}
