#version 460
#extension GL_GOOGLE_include_directive : require
// Per sample: one component of its means.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, means)
WRITE_F(1, value)
PARAMS(field_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(value, i) = LOAD_V(means, i)[k.component];
}
