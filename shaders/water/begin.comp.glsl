#version 460
#extension GL_GOOGLE_include_directive : require
// Per span: lists those without donors, which pass their rain on in round 0.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, waits)
WRITE_U(1, passing)
WRITE_U(2, length) // of the lists of three rounds
PARAMS(water_params)

void main()
{
    uint i = THREAD;
    if (i < k.n && LOAD_U(waits, i) == 0u)
        AT(passing, atomicAdd(AT(length, 0), 1u)) = i;
}
