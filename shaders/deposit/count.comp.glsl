#version 460
#extension GL_GOOGLE_include_directive : require
// Per run of SCAN_RUN particles: counts its deposits.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, phase)
WRITE_U(1, counts)
PARAMS(scan_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint sum = 0u, end = min((i + 1u) * SCAN_RUN, k.n_values);
    for (uint j = i * SCAN_RUN; j < end; j++)
        sum += LOAD_U(phase, j) == 1u ? 1u : 0u;
    if (sum > 0u)
        atomicAdd(AT(counts, COUNT_LANDED), sum);
}
