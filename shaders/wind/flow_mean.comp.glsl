#version 460
#extension GL_GOOGLE_include_directive : require
// The averaged velocity and share of air in the box's cells.
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
