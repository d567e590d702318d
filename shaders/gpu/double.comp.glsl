#version 460
#extension GL_GOOGLE_include_directive : require
// Per item, one pass of pointer doubling: to[i] = from[from[i]]. Sets the flag if any pointer moved.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, from)
WRITE_U(1, to)
WRITE_U(2, flags)
PARAMS(double_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint a = LOAD_U(from, i), b = LOAD_U(from, a);
    AT(to, i) = b;
    if (a != b)
        AT(flags, k.flag) = 1u;
}
