#version 460
#extension GL_GOOGLE_include_directive : require
// A cell's pointer before it is doubled: itself where crumbs may land, else its receiver.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, receiver)
READ_U(1, room)
WRITE_U(2, pointer)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(pointer, i) = LOAD_U(room, i) > 0u ? i : LOAD_U(receiver, i);
}
