#version 460
#extension GL_GOOGLE_include_directive : require
// One group: reduces REDUCE_THREADS partial values to scalars[slot] in a fixed tree.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, partial)
WRITE_F(1, scalars)
PARAMS(reduce_end_params)

shared float leaf[64];

void main()
{
    uint i = gl_LocalInvocationID.x;
    float value = 0.0;
    for (uint j = i; j < REDUCE_THREADS; j += 64u) {
        float other = LOAD_F(partial, j);
        value = k.maximum != 0u ? max(value, other) : value + other;
    }
    leaf[i] = value;
    for (uint stride = 32u; stride > 0u; stride /= 2u) {
        barrier();
        if (i < stride)
            leaf[i] = k.maximum != 0u ? max(leaf[i], leaf[i + stride]) : leaf[i] + leaf[i + stride];
    }
    if (i == 0u)
        AT(scalars, k.slot) = leaf[0];
}
