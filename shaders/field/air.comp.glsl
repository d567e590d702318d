#version 460
#extension GL_GOOGLE_include_directive : require
// Per pixel: wind speed over the surface, sampled one spacing of the air's lattice off the rock, since it is 0
// on the rock itself.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, hit)
READ_V(1, facing)
READ_V(2, velocity)
WRITE_F(3, speed)
PARAMS(pixel_air_params)

vec3 velocity_at(vec3 x)
{
    uvec3 n = uvec3(k.ax, k.ay, k.az);
    vec3 at = clamp((x - vec3(k.origin_x, k.origin_y, k.origin_z)) / k.cell, vec3(0.0), max(vec3(n) - 1.001, vec3(0.0)));
    uvec3 c = uvec3(at);
    vec3 f = at - vec3(c), sum = vec3(0.0);
    for (uint b = 0u; b < 8u; b++) {
        uvec3 corner = uvec3(b & 1u, (b >> 1) & 1u, b >> 2);
        vec3 near = mix(1.0 - f, f, vec3(corner));
        uvec3 d = min(c + corner, n - 1u);
        sum += near.x * near.y * near.z * LOAD_V(velocity, (d.z * n.y + d.y) * n.x + d.x).xyz;
    }
    return sum;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    vec4 where = LOAD_V(hit, i);
    AT(speed, i) = where.w >= 0.0 ? length(velocity_at(where.xyz + k.cell * LOAD_V(facing, i).xyz)) : 0.0;
}
