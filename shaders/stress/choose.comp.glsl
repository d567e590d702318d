#version 460
#extension GL_GOOGLE_include_directive : require
// Per run of the whole grid: writes the run's number into its slot, from the exclusive prefix sum of the marks.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, before)
WRITE_U(1, run)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint slot = LOAD_U(before, i);
    if (LOAD_U(before, i + 1u) != slot)
        AT(run, STRESS_FIRST + slot) = i;
}
