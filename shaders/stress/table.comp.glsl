#version 460
#extension GL_GOOGLE_include_directive : require
// Where each kept run begins.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, run)
WRITE_U(1, table)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(table, LOAD_U(run, STRESS_FIRST + i)) = STRESS_RUN * (STRESS_FIRST + i);
}
