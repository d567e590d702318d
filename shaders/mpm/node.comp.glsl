#version 460
#extension GL_GOOGLE_include_directive : require
// The grid's velocity after a step: momentum over mass, gravity, and contact with ground and resting rock, which
// bodies may leave but not enter and rub along by Coulomb's law.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, slot)
READ_V(2, partial)
READ_V(3, wall)
WRITE_V(4, node_velocity)
PARAMS(mpm_params)
#include "mpm/grid.glsl"
#include "mpm/sum.glsl"

vec3 off_wall(vec3 v, vec3 n)
{
    float into = dot(v, n);
    if (into >= 0.0)
        return v;
    vec3 along = v - into * n;
    float speed = length(along);
    return speed > 0.0 ? along * max(1.0 + k.friction * into / speed, 0.0) : vec3(0.0);
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(list, i);
    vec4 sum = node_sum(node);
    vec3 v = sum.w > 0.0 ? sum.xyz / sum.w - vec3(0.0, 0.0, k.gravity * k.dt) : vec3(0.0);
    float speed = length(v);
    if (speed > k.fastest)
        v *= k.fastest / speed;
    if (k.rock != 0u) {
        vec4 n = LOAD_V(wall, node);
        if (n.w > 0.0)
            v = off_wall(v, n.xyz);
    }
    if (mpm_at(node).z <= 1)
        v = off_wall(v, vec3(0.0, 0.0, 1.0));
    AT(node_velocity, node) = vec4(v, sum.w);
}
