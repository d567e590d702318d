#version 460
#extension GL_GOOGLE_include_directive : require
// Per run of SCAN_RUN values, first half of a prefix sum: the run's sum.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, values)
WRITE_U(1, sums)
PARAMS(scan_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint end = min((i + 1u) * SCAN_RUN, k.n_values), sum = 0u;
    for (uint j = i * SCAN_RUN; j < end; j++)
        sum += LOAD_U(values, j);
    AT(sums, i) = sum;
}
