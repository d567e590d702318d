#version 460
#extension GL_GOOGLE_include_directive : require
// Per cell: 1 if fragments may land in it: rock under air, not an outlet.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, tag)
WRITE_U(1, ground)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(ground, i) = (LOAD_U(tag, i) & (WATER_KIND | WATER_OUT)) == WATER_SURF ? 1u : 0u;
}
