#version 460
#extension GL_GOOGLE_include_directive : require
// Per cell of the box: counts the cells that held surface in the last run, and the cells in which that has
// changed.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, was)
READ_U(1, is)
WRITE_U(2, counts)
PARAMS(flow_params)

void main()
{
    uint c = THREAD;
    if (c >= k.n)
        return;
    uint a = LOAD_U(was, c), b = LOAD_U(is, c);
    if (a != 0u)
        atomicAdd(AT(counts, 0u), 1u);
    if (a != b)
        atomicAdd(AT(counts, 1u), 1u);
}
