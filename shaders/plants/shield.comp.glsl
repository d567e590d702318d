#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle: intensity *= 1 - shelter c, with its cover c.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_F(1, vegetation)
WRITE_F(2, intensity)
PARAMS(plants_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(intensity, i) *= 1.0 - k.shelter * LOAD_F(vegetation, LOAD_U(list, i));
}
