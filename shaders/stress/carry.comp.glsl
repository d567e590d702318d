#version 460
#extension GL_GOOGLE_include_directive : require
// Per slot of the new layout: copies the displacement u from its slot in the old layout; 0 where the old layout
// has none.
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
