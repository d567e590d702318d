#version 460
#extension GL_GOOGLE_include_directive : require
// The displacement of the nodes that are kept from now on, from where it is kept so far; 0 where it is not.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, run)
READ_U(1, table)
READ_V(2, u)
WRITE_V(3, carried)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint own = LOAD_U(run, i / STRESS_RUN);
    AT(carried, i) = own == STRESS_NO_RUN ? vec4(0.0) : LOAD_V(u, LOAD_U(table, own) + i % STRESS_RUN);
}
