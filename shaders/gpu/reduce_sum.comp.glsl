#version 460
#extension GL_GOOGLE_include_directive : require
// Per partial value: sum over every REDUCE_THREADS-th value. The tree of additions is the same on every device.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, values)
WRITE_F(1, partial)
PARAMS(reduce_params)

void main()
{
    uint i = THREAD;
    float sum = 0.0;
    for (uint j = i; j < k.n_values; j += REDUCE_THREADS)
        sum += LOAD_F(values, j);
    AT(partial, i) = sum;
}
