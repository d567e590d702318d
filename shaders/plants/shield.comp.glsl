#version 460
#extension GL_GOOGLE_include_directive : require
// What wind and rain do to each particle of the surface, less what its plants keep off.
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
