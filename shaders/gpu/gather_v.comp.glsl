#version 460
#extension GL_GOOGLE_include_directive : require
// Per item: to[i] = from[order[i]], vec4.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, order)
READ_V(1, from)
WRITE_V(2, to)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(to, i) = LOAD_V(from, LOAD_U(order, i));
}
