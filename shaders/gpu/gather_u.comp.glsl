#version 460
#extension GL_GOOGLE_include_directive : require
// Per item: to[i] = from[order[i]], uint.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, order)
READ_U(1, from)
WRITE_U(2, to)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(to, i) = LOAD_U(from, LOAD_U(order, i));
}
