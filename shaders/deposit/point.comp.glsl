#version 460
#extension GL_GOOGLE_include_directive : require
// Per cell: initial pointer, to itself if fragments may land in it, else to its receiver (Arenite section 7,
// before pointer jumping).
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
