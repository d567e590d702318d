#version 460
#extension GL_GOOGLE_include_directive : require
// Per pixel: marches one ray through the distance field: hit point, normal and lighting.
// hit = (P, camera-plane depth; -1: nothing; HIT_GROUND - depth: the ground around). facing = (N, LIT_SUN +
// LIT_SKY). With several samples per pixel each has its own point on the sun's disc and its own direction of
// the sky.
#include "shared/buffers.glsl"
#include "shared/params.h"
#include "shared/random.glsl"

READ_U(0, slot)
READ_F(1, distance_field)
WRITE_V(2, hit)
WRITE_V(3, facing)
PARAMS(march_params)
#include "field/trilinear.glsl"

// The sun's disc is larger than the real one (half a degree), as in haze, for softer shadows.
const float SUN_RADIUS = 0.02;

// Two numbers per sample, evenly distributed over a pixel's samples and between pixels: a Kronecker sequence, shifted by a hash.
vec2 even(uint pixel, uint purpose)
{
    vec2 start = vec2(random_float(random_hash(pixel, purpose, 0u, 0u)), random_float(random_hash(pixel, purpose, 1u, 0u)));
    return fract(start + float(k.ray) * vec2(0.7548776662, 0.5698402910));
}

// Two unit vectors perpendicular to n and to each other.
void across(vec3 n, out vec3 a, out vec3 b)
{
    a = normalize(abs(n.z) < 0.9 ? cross(n, vec3(0.0, 0.0, 1.0)) : cross(n, vec3(1.0, 0.0, 0.0)));
    b = cross(n, a);
}

// What is left of a part of a ray when the rock is cut; nothing if the first number is larger.
vec2 kept(vec3 from, vec3 along, vec2 span)
{
    if (k.cut == 0u)
        return span;
    uint axis = k.cut & 3u;
    float side = (k.cut & CUT_KEEPS_HIGH) != 0u ? -1.0 : 1.0;
    float beyond = side * (from[axis] - k.cut_at), away = side * along[axis];
    if (abs(away) < 1e-12)
        return beyond > 0.0 ? vec2(1.0, 0.0) : span;
    float crossing = -beyond / away;
    return away < 0.0 ? vec2(max(span.x, crossing), span.y) : vec2(span.x, min(span.y, crossing));
}

// Whether rock is in the way.
bool hidden(vec3 from, vec3 along)
{
    return march(from, along, kept(from, along, box_span(from, along))) >= 0.0;
}

// `lift`: distance from the surface, in voxels, at which rays begin. The field is smoothed over 1.5 voxels; the ground is not in it.
float lit(uint i, vec3 x, vec3 n, float lift)
{
    vec3 sun = vec3(k.sun_x, k.sun_y, k.sun_z), lifted = x + lift * k.voxel * n, a, b;
    float sum = 0.0;
    if (k.rays > 1u) {
        vec2 u = even(i, 1u);
        float r = SUN_RADIUS * sqrt(u.x), turn = 6.28318530718 * u.y;
        across(sun, a, b);
        sun = normalize(sun + r * cos(turn) * a + r * sin(turn) * b);
    }
    if (dot(n, sun) > 0.0 && !hidden(lifted, sun))
        sum += LIT_SUN;
    if (k.rays == 1u)
        return sum + LIT_SKY;
    // Cosine-weighted direction of the sky above the surface.
    vec2 u = even(i, 2u);
    float r = sqrt(u.x), turn = 6.28318530718 * u.y;
    across(n, a, b);
    vec3 up = normalize(r * cos(turn) * a + r * sin(turn) * b + sqrt(1.0 - u.x) * n);
    return hidden(lifted, up) ? sum : sum + LIT_SKY;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    vec2 film = (vec2(i % k.width, i / k.width) + vec2(k.film_x, k.film_y)) / vec2(k.width, k.height) * 2.0 - 1.0;
    vec3 eye = vec3(k.eye_x, k.eye_y, k.eye_z), ahead = vec3(k.ahead_x, k.ahead_y, k.ahead_z);
    vec3 along = normalize(ahead + film.x * vec3(k.right_x, k.right_y, k.right_z) +
                           film.y * vec3(k.down_x, k.down_y, k.down_z));
    vec2 box = box_span(eye, along), span = kept(eye, along, box);
    float t = span.x <= span.y ? march(eye, along, span) : -1.0;
    vec4 where = vec4(0.0, 0.0, 0.0, -1.0), normal = vec4(0.0);
    if (t >= 0.0) {
        vec3 x = eye + t * along, g = gradient_at(x);
        vec3 n = dot(g, g) > 0.0 ? normalize(g) : -along;
        if (span.x > box.x && t == span.x) { // on the cut
            n = vec3(0.0);
            n[k.cut & 3u] = -sign(along[k.cut & 3u]);
        }
        where = vec4(x, t * dot(along, ahead));
        normal = vec4(n, lit(i, x, n, 1.5));
    } else if (k.ground != 0u && along.z < 0.0 && eye.z > 0.0) {
        float down = -eye.z / along.z;
        vec3 x = vec3((eye + down * along).xy, 0.0), n = vec3(0.0, 0.0, 1.0);
        where = vec4(x, HIT_GROUND - down * dot(along, ahead));
        normal = vec4(n, lit(i, x, n, 0.05));
    }
    AT(hit, i) = where;
    AT(facing, i) = normal;
}
