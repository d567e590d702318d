#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle: its retreat in m/kyr, of rock and of deposits, from which water alone removes material.
// The host limits the time step by the maxima.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_F(1, intensity) // by place in the list
READ_F(2, erodibility)
READ_U(3, phase)
READ_U(4, parts) // by place in the list
WRITE_F(5, rock)
WRITE_F(6, loose)
PARAMS(count_params)
#include "erosion/parts.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    float speed = LOAD_F(intensity, i) * LOAD_F(erodibility, self);
    bool is_loose = LOAD_U(phase, self) == PHASE_DEPOSIT;
    AT(rock, i) = is_loose ? 0.0 : speed;
    AT(loose, i) = is_loose ? speed * shares_in(LOAD_U(parts, i)).y : 0.0;
}
