#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle of rock: intensity *= rate^(n.a / 2) (rate per metre)^z, with a the azimuth's unit
// vector: sqrt(rate) on a wall that faces the azimuth, 1/sqrt(rate) on one that faces away, 1 on level ground.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_V(2, normal)
READ_U(3, phase)
WRITE_F(4, intensity) // by place in the list
PARAMS(aspect_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    if (LOAD_U(phase, self) == PHASE_DEPOSIT)
        return;
    vec3 n = LOAD_V(normal, self).xyz;
    AT(intensity, i) *= exp(dot(n.xy, vec2(k.x, k.y)) + k.per_m * LOAD_V(position, self).z);
}
