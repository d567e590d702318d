#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: |v|.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, velocity)
WRITE_F(1, speed)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(speed, i) = length(LOAD_V(velocity, i).xyz);
}
