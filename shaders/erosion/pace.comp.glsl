#version 460
#extension GL_GOOGLE_include_directive : require
// How fast the surface retreats, m/kyr.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_F(1, intensity) // by place in the list
READ_F(2, erodibility)
WRITE_F(3, speed)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(speed, i) = LOAD_F(intensity, i) * LOAD_F(erodibility, LOAD_U(list, i));
}
