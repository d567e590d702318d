#version 460
#extension GL_GOOGLE_include_directive : require
// Kinetic damping: once the kinetic energy has passed a peak, all motion stops.
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
