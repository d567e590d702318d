#version 460
#extension GL_GOOGLE_include_directive : require
// Per moving node: the smoother's first step from u = 0, z = gain r / diagonal.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, r)
WRITE_V(2, z)
PARAMS(smooth_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    vec4 residual = LOAD_V(r, i);
    AT(z, LOAD_U(list, i)) = vec4(k.gain * residual.w * residual.xyz, 0.0);
}
