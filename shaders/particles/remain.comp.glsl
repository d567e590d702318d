#version 460
#extension GL_GOOGLE_include_directive : require
// 1 for each particle that stays: of which something is left, or that waits to come to rest, its viability being negative.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, viability)
WRITE_F(1, stays)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(stays, i) = LOAD_F(viability, i) != 0.0 ? 1.0 : 0.0;
}
