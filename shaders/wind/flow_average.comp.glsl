#version 460
#extension GL_GOOGLE_include_directive : require
// Per cell of the box: adds the kernel-weighted sum of air velocities at the cell's centre, and of the weights
// (Shepard 1968), to the current block of samples.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, start)
READ_V(1, position)
READ_V(2, velocity)
WRITE_V(3, block)
PARAMS(flow_params)
#include "wind/flow.glsl"
#include "wind/cells.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    vec3 x = vec3(i % k.bx, i / k.bx % k.by, i / (k.bx * k.by)) + 0.5;
    vec4 sum = vec4(0.0);
    FLOW_EACH(x,
        float r2 = dot(LOAD_V(position, j).xyz - x, LOAD_V(position, j).xyz - x);
        if (r2 < FLOW_SUPPORT * FLOW_SUPPORT) {
            vec4 v = LOAD_V(velocity, j);
            if (v.w <= FLOW_SKIN)
                sum += flow_kernel(sqrt(r2)) * vec4(v.xyz, 1.0);
        })
    AT(block, i) += sum;
}
