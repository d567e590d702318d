#version 460
#extension GL_GOOGLE_include_directive : require
// The averaged velocity. Where the kernel finds little air, in rock and in caves too narrow for the air's
// spacing, it fades to none. w: the share of space around that is air.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, sums)
WRITE_V(1, mean)
PARAMS(flow_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    vec4 sum = k.gain * LOAD_V(sums, i);
    AT(mean, i) = vec4(sum.xyz / max(sum.w, 0.25), min(sum.w, 1.0));
}
