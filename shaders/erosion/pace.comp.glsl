#version 460
#extension GL_GOOGLE_include_directive : require
// How fast the surface retreats, m/kyr: rock, and deposits.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_F(1, intensity) // by place in the list
READ_F(2, erodibility)
READ_U(3, phase)
WRITE_F(4, rock)
WRITE_F(5, loose)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    float speed = LOAD_F(intensity, i) * LOAD_F(erodibility, self);
    bool is_loose = LOAD_U(phase, self) == 1u;
    AT(rock, i) = is_loose ? 0.0 : speed;
    AT(loose, i) = is_loose ? speed : 0.0;
}
