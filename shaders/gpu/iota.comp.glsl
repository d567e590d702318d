#version 460
#extension GL_GOOGLE_include_directive : require
// Per item: values[i] = i.
#include "shared/buffers.glsl"
#include "shared/params.h"

WRITE_U(0, values)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(values, i) = i;
}
