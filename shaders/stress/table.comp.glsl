#version 460
#extension GL_GOOGLE_include_directive : require
// Per kept run: enters the run's first slot into the table of the whole grid.
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
