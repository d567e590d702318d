#version 460
#extension GL_GOOGLE_include_directive : require
// Per item: if its flag is set, writes its number to the list at the flags' exclusive prefix sum.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, flags)
READ_U(1, place)
WRITE_U(2, list)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n && LOAD_U(flags, i) != 0u)
        AT(list, LOAD_U(place, i)) = i;
}
