#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle: normal, the direction in which its 20 nearest neighbours spread least (Arenite 5.1,
// after Hoppe et al. 1992), pointing away from the rock. Neighbours are searched in the 5^3 voxels around.
//
// The distance of the 20th neighbour is found by counting into 16 bins, then into 16 parts of its bin: exact to
// 0.025 h^2, without sorting.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_U(2, words)
READ_U(3, start)
WRITE_V(4, normal)
PARAMS(voxel_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"
#include "particles/sides.glsl"

const uint NEIGHBOURS = 20u;
const float REACH2 = 6.25; // h^2

// Runs BODY for each other particle j near i, images in walls included; d is its offset in units of h.
#define EACH_NEIGHBOUR(BODY)                                                                              \
    for (int image = 0; image < (k.walls == 0u ? 1 : SIDE_IMAGES); image++) {                             \
        vec3 at = x / k.h, flip;                                                                          \
        if (!side_image(image, at.xy, flip))                                                              \
            continue;                                                                                     \
        ivec3 middle = image == 0 ? v : ivec3(floor(at));                                                 \
        ivec3 low = max(middle - 2, ivec3(0)), high = min(middle + 2, ivec3(k.nx, k.ny, k.nz) - 1);       \
        if (low.x > high.x)                                                                               \
            continue;                                                                                     \
        for (int z = low.z; z <= high.z; z++)                                                             \
            for (int y = low.y; y <= high.y; y++) {                                                       \
                uvec2 row = row_particles(low.x, high.x, y, z);                                           \
                for (uint j = row.x; j < row.y; j++) {                                                    \
                    bool other = image != 0 || j != self;                                                 \
                    vec3 d = flip * (LOAD_V(position, j).xyz / k.h - at);                                 \
                    BODY                                                                                  \
                }                                                                                         \
            }                                                                                             \
    }

// Sixteen 8-bit counters.
void count(inout uvec4 bins, uint bin)
{
    uint one = 1u << ((bin & 3u) * 8u), word = bin >> 2;
    bins += uvec4(word == 0u ? one : 0u, word == 1u ? one : 0u, word == 2u ? one : 0u, word == 3u ? one : 0u);
}

// The bin in which the cumulative count, starting from `before`, reaches NEIGHBOURS; 16 if it does not.
uint reached(uvec4 bins, inout uint before)
{
    uint found = 16u;
    for (uint b = 0u; b < 16u; b++) {
        uint word = b < 4u ? bins.x : b < 8u ? bins.y : b < 12u ? bins.z : bins.w;
        uint in_bin = (word >> ((b & 3u) * 8u)) & 255u;
        if (found == 16u) {
            if (before + in_bin >= NEIGHBOURS)
                found = b;
            else
                before += in_bin;
        }
    }
    return found;
}

// Unit eigenvector of the smallest eigenvalue of [a.x b.x b.y; b.x a.y b.z; b.y b.z a.z]; 0 if it is not
// unique.
vec3 least_spread(vec3 a, vec3 b)
{
    float q = (a.x + a.y + a.z) / 3.0;
    vec3 c = a - q;
    float p = sqrt((dot(c, c) + 2.0 * dot(b, b)) / 6.0);
    if (p <= 1e-6 * q)
        return vec3(0.0);
    vec3 cc = c / p, bb = b / p;
    float det = cc.x * (cc.y * cc.z - bb.z * bb.z) - bb.x * (bb.x * cc.z - bb.z * bb.y) + bb.y * (bb.x * bb.z - cc.y * bb.y);
    float least = q + 2.0 * p * cos(acos(clamp(0.5 * det, -1.0, 1.0)) / 3.0 + 2.0943951);
    vec3 r0 = vec3(a.x - least, b.x, b.y), r1 = vec3(b.x, a.y - least, b.z), r2 = vec3(b.y, b.z, a.z - least);
    vec3 n0 = cross(r0, r1), n1 = cross(r0, r2), n2 = cross(r1, r2);
    float l0 = dot(n0, n0), l1 = dot(n1, n1), l2 = dot(n2, n2);
    vec3 n = l0 >= l1 && l0 >= l2 ? n0 : l1 >= l2 ? n1 : n2;
    float l = max(l0, max(l1, l2));
    return l > 1e-12 * q * q * q * q ? n * inversesqrt(l) : vec3(0.0);
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    vec3 x = LOAD_V(position, self).xyz;
    ivec3 v = voxel_of(x);

    uvec4 bins = uvec4(0u);
    vec3 inward = vec3(0.0);
    EACH_NEIGHBOUR(
        float d2 = dot(d, d);
        inward += d;
        if (d2 < REACH2 && other)
            count(bins, uint(d2 * (16.0 / REACH2)));)
    uint before = 0u;
    uint bin = reached(bins, before);
    float cut = REACH2;
    if (bin < 16u) {
        float from = float(bin) * (REACH2 / 16.0);
        uvec4 parts = uvec4(0u);
        EACH_NEIGHBOUR(
            float d2 = dot(d, d) - from;
            if (d2 >= 0.0 && d2 < REACH2 / 16.0 && other)
                count(parts, uint(d2 * (256.0 / REACH2)));)
        uint part = reached(parts, before);
        cut = from + float(min(part, 15u) + 1u) * (REACH2 / 256.0);
    }

    float n = 0.0;
    vec3 sum = vec3(0.0), square = vec3(0.0), cross_terms = vec3(0.0);
    EACH_NEIGHBOUR(
        if (dot(d, d) <= cut) {
            n += 1.0;
            sum += d;
            square += d * d;
            cross_terms += vec3(d.x * d.y, d.x * d.z, d.y * d.z);
        })
    vec3 mean = sum / n;
    vec3 a = square / n - mean * mean;
    vec3 b = cross_terms / n - vec3(mean.x * mean.y, mean.x * mean.z, mean.y * mean.z);
    vec3 out_of_rock = least_spread(a, b);
    if (dot(out_of_rock, out_of_rock) < 0.5)
        out_of_rock = dot(inward, inward) > 0.0 ? -normalize(inward) : vec3(0.0, 0.0, 1.0);
    AT(normal, self) = vec4(dot(out_of_rock, inward) > 0.0 ? -out_of_rock : out_of_rock, 0.0);
}
