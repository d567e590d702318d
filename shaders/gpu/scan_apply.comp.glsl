#version 460
#extension GL_GOOGLE_include_directive : require
// Per run of SCAN_RUN values, second half of an exclusive prefix sum, in place.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, values)
READ_U(1, sums)
WRITE_U(2, scanned)
PARAMS(scan_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint end = min((i + 1u) * SCAN_RUN, k.n_values), sum = LOAD_U(sums, i);
    for (uint j = i * SCAN_RUN; j < end; j++) {
        uint value = LOAD_U(values, j);
        AT(scanned, j) = sum;
        sum += value;
    }
}
