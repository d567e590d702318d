#version 460
#extension GL_GOOGLE_include_directive : require
// Per boundary particle: one in each cell that holds surface of the rock, and a layer under the ground. Each is
// half a spacing behind the surface it stands for, so that a flat layer and the lattice of air in front of it
// are at rest density.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, sums)
WRITE_V(2, position)
WRITE_V(3, velocity)
WRITE_U(4, id)
WRITE_U(5, key)
WRITE_F(6, density_pressure)
WRITE_F(7, divergence_pressure)
PARAMS(flow_params)
#include "wind/flow.glsl"

vec3 signed_sum(uint at)
{
    return vec3(int(LOAD_U(sums, at)), int(LOAD_U(sums, at + 1u)), int(LOAD_U(sums, at + 2u)));
}

void main()
{
    uint i = THREAD, slot = k.first + i;
    if (i >= k.n || slot >= k.slots)
        return;
    uint ground = k.bx * k.by;
    vec3 x;
    if (i < ground) {
        x = vec3(float(i % k.bx) + 0.5, float(i / k.bx) + 0.5, -0.5);
        AT(id, slot) = FLOW_GROUND_ID + i;
    } else {
        uint c = LOAD_U(list, i - ground);
        float per = 1.0 / (FLOW_FIXED * float(LOAD_U(sums, 8u * c)));
        vec3 corner = vec3(c % k.bx, c / k.bx % k.by, c / (k.bx * k.by));
        /* the rock's particles are already half a voxel behind its surface */
        float behind = 0.5 - 0.5 * k.h / k.spacing;
        x = corner + per * (signed_sum(8u * c + 1u) - behind * signed_sum(8u * c + 4u));
        AT(id, slot) = FLOW_ROCK_ID + c;
    }
    AT(position, slot) = vec4(x, 0.0);
    AT(velocity, slot) = vec4(0.0, 0.0, 0.0, i < ground ? FLOW_GROUND : FLOW_ROCK);
    AT(density_pressure, slot) = 0.0;
    AT(divergence_pressure, slot) = 0.0;
    AT(key, slot) = flow_index(flow_cell(x));
}
