#version 460
#extension GL_GOOGLE_include_directive : require
// Second half of a scan: each run's values become the sums of all before them. In place.
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
