#version 460
#extension GL_GOOGLE_include_directive : require
// Pointers for the sum along receivers; what is outside stays there.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, receiver)
WRITE_U(1, pointer)
PARAMS(water_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    AT(pointer, i) = i < k.nodes ? LOAD_U(receiver, i) : k.nodes;
}
