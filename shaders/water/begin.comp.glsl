#version 460
#extension GL_GOOGLE_include_directive : require
// Per span: spans without donors pass their rain on in round 0.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, waits)
WRITE_U(1, when)
PARAMS(water_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(when, i) = LOAD_U(waits, i) == 0u ? 0u : 0xffffffffu;
}
