#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: 1 if it stays: if it has viability left, or waits to be deposited (viability < 0).
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
