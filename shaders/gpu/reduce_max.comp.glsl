#version 460
#extension GL_GOOGLE_include_directive : require
// Per partial value: maximum of |x| over every REDUCE_THREADS-th value. A NaN gives infinity.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, values)
WRITE_F(1, partial)
PARAMS(reduce_params)

void main()
{
    uint i = THREAD;
    float most = 0.0;
    for (uint j = i; j < k.n_values; j += REDUCE_THREADS) {
        float value = LOAD_F(values, j);
        most = isnan(value) ? uintBitsToFloat(0x7f800000u) : max(most, abs(value));
    }
    AT(partial, i) = most;
}
