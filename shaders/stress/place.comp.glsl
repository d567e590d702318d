#version 460
#extension GL_GOOGLE_include_directive : require
// Per moving node: scatters a value in list order to the node's slot.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, value)
WRITE_V(2, u)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(u, LOAD_U(list, i)) = LOAD_V(value, i);
}
