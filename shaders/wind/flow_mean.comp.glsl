#version 460
#extension GL_GOOGLE_include_directive : require
// Per cell of the box: averaged velocity and share of air, from the sums (mean.glsl).
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, sums)
WRITE_V(1, mean)
PARAMS(flow_params)
#include "wind/mean.glsl"

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(mean, i) = flow_mean(LOAD_V(sums, i));
}
