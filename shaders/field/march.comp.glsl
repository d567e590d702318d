#version 460
#extension GL_GOOGLE_include_directive : require
// One ray a pixel into the distance field: where it meets the rock, the normal there, and whether the sun
// does. hit = (P, camera-plane depth or -1); facing = (N, sunlit 0 or 1).
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, distance_field)
WRITE_V(1, hit)
WRITE_V(2, facing)
PARAMS(march_params)
#include "field/trilinear.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    vec2 film = (vec2(i % k.width, i / k.width) + 0.5) / vec2(k.width, k.height) * 2.0 - 1.0;
    vec3 eye = vec3(k.eye_x, k.eye_y, k.eye_z), ahead = vec3(k.ahead_x, k.ahead_y, k.ahead_z);
    vec3 along = normalize(ahead + film.x * vec3(k.right_x, k.right_y, k.right_z) +
                           film.y * vec3(k.down_x, k.down_y, k.down_z));
    vec2 span = box_span(eye, along);
    float t = span.x <= span.y ? march(eye, along, span) : -1.0;
    vec4 where = vec4(0.0, 0.0, 0.0, -1.0), normal = vec4(0.0);
    if (t >= 0.0) {
        vec3 x = eye + t * along, g = gradient_at(x);
        vec3 n = dot(g, g) > 0.0 ? normalize(g) : -along;
        vec3 sun = vec3(k.sun_x, k.sun_y, k.sun_z), lifted = x + 1.5 * k.voxel * n;
        float lit = 0.0;
        if (dot(n, sun) > 0.0)
            lit = march(lifted, sun, box_span(lifted, sun)) < 0.0 ? 1.0 : 0.0;
        where = vec4(x, t * dot(along, ahead));
        normal = vec4(n, lit);
    }
    AT(hit, i) = where;
    AT(facing, i) = normal;
}
