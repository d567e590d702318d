#version 460
#extension GL_GOOGLE_include_directive : require
// Per sample beside a wall: cuts the rock off plane at the domain's side, although it continues beyond, and
// leaves the inside as it is.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
WRITE_F(1, distance_field)
WRITE_F(2, share)
WRITE_V(3, means)
PARAMS(field_params)
#include "field/lattice.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 c = brick_sample(LOAD_U(list, i / BRICK_SAMPLES), i % BRICK_SAMPLES);
    vec3 x = vec3(c - int(k.margin)) + 0.5;
    float beyond = -1e9; // voxels
    if ((k.walls & WALL_X_MIN) != 0u)
        beyond = max(beyond, -x.x);
    if ((k.walls & WALL_X_MAX) != 0u)
        beyond = max(beyond, x.x - float(k.nx));
    if ((k.walls & WALL_Y_MIN) != 0u)
        beyond = max(beyond, -x.y);
    if ((k.walls & WALL_Y_MAX) != 0u)
        beyond = max(beyond, x.y - float(k.ny));
    AT(distance_field, i) = clamp(max(AT(distance_field, i), beyond * k.h), -3.0 * k.h, 3.0 * k.h);
    if (beyond > 0.0) {
        AT(share, i) = 0.0;
        AT(means, i) = vec4(0.0);
    }
}
