#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: clears the age of those whose viability is used up, in case they come to rest as deposits.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, viability)
WRITE_F(1, exposed)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n && LOAD_F(viability, i) <= 0.0)
        AT(exposed, i) = 0.0;
}
