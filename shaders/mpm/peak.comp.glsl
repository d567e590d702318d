#version 460
#extension GL_GOOGLE_include_directive : require
// One group of 64, kinetic damping: if the kinetic energy has fallen since the last step it has passed a peak,
// and all motion is stopped.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, partial)
WRITE_F(1, scalars)
PARAMS(count_params)
#include "stress/total.glsl"

void main()
{
    float energy = total(), last = AT(scalars, MPM_LAST);
    if (gl_LocalInvocationID.x != 0u)
        return;
    bool passed = energy < last;
    AT(scalars, MPM_LAST) = passed ? 0.0 : energy;
    AT(scalars, MPM_KEEP) = passed ? 0.0 : 1.0;
    if (passed)
        AT(scalars, MPM_PEAK) = last;
}
