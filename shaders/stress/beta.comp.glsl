#version 460
#extension GL_GOOGLE_include_directive : require
// Conjugate gradients, one group of 64: beta = r.z / (r.z of the previous step), from the partial sums of r.z;
// 0 in the first step.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, partial)
WRITE_F(1, scalars)
PARAMS(cg_params)
#include "stress/total.glsl"

void main()
{
    float rz = total();
    if (gl_LocalInvocationID.x != 0u)
        return;
    float before = AT(scalars, CG_RZ);
    AT(scalars, CG_BETA) = k.first == 0u && before > 0.0 ? rz / before : 0.0;
    AT(scalars, CG_RZ) = rz;
}
