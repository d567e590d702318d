#version 460
#extension GL_GOOGLE_include_directive : require
// Per kept brick: its place in the list plus 1.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
WRITE_U(1, slot)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(slot, LOAD_U(list, i)) = i + 1u;
}
