#version 460
#extension GL_GOOGLE_include_directive : require
// Per pixel: fields at the hit point, and the stone's colour under sun and sky. With several samples, the last
// of which comes first, the colour is their mean and the rest is that of sample 0.
// fields = means (stress, von Mises, viability, deposits); color = linear RGB and alpha; ids = layer, phase and
// number of the nearest particle.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, hit)
READ_V(1, facing)
READ_V(2, means)
READ_V(3, position)
READ_U(4, start)
READ_U(5, layer)
READ_U(6, phase)
READ_F(7, vegetation)
READ_V(8, palette)
WRITE_V(9, color)
WRITE_V(10, fields)
WRITE_U(11, ids)
READ_U(12, slot)
READ_U(13, words)
PARAMS(shade_params)
#include "field/lattice.glsl"
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"

const vec3 SAND = vec3(0.52, 0.36, 0.22);
const vec3 GREEN = vec3(0.085, 0.115, 0.045); // dry shrubs

vec3 stone_of(uint j)
{
    vec3 stone = LOAD_V(palette, LOAD_U(layer, j)).rgb;
    if (LOAD_U(phase, j) == PHASE_DEPOSIT)
        stone = mix(stone, SAND, 0.6);
    return mix(stone, GREEN, LOAD_F(vegetation, j));
}

// Sun and sky on a white surface.
vec3 light_on(vec4 normal)
{
    bool sun_seen = mod(normal.w, 2.0) >= LIT_SUN, sky_seen = normal.w >= LIT_SKY;
    float sun = sun_seen ? max(dot(normal.xyz, vec3(k.sun_x, k.sun_y, k.sun_z)), 0.0) : 0.0;
    float up = 0.5 + 0.5 * normal.z;
    // Directions that do not see the sky see rock, which reflects a part.
    float open = k.rays == 1u || sky_seen ? 1.0 : 0.12;
    return sun * vec3(k.sun_r, k.sun_g, k.sun_b) +
           open * mix(vec3(k.bounce_r, k.bounce_g, k.bounce_b), vec3(k.sky_r, k.sky_g, k.sky_b), up);
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    vec4 where = LOAD_V(hit, i);
    if (k.ray + 1u == k.rays) // samples come in descending order: this is the first
        AT(color, i) = vec4(0.0);
    if (where.w < 0.0) {
        if (where.w <= HIT_GROUND)
            AT(color, i) += vec4(vec3(GROUND_R, GROUND_G, GROUND_B) * light_on(LOAD_V(facing, i)), 1.0) / float(k.rays);
        AT(fields, i) = vec4(0.0);
        for (uint b = 0u; b < 3u; b++)
            AT(ids, 3u * i + b) = 0u;
        return;
    }
    vec3 x = where.xyz;
    ivec3 v = voxel_of(x), last = ivec3(k.nx, k.ny, k.nz) - 1;
    float nearest = 1e30, weighed = 0.0;
    uint found = 0u;
    // Colour: mean over the particles around, weighted by distance, so that beds and heaps blend whatever the particles' positions.
    // The voxels around that of x hold all particles within a spacing, beyond which the weight is small; farther ones are searched
    // only if there are none.
    vec3 stone = vec3(0.0);
    for (int reach = 1; reach <= 2 && nearest > k.h * k.h; reach++) {
        ivec3 low = clamp(v - reach, ivec3(0), last), high = clamp(v + reach, ivec3(0), last);
        for (int z = low.z; z <= high.z; z++)
            for (int y = low.y; y <= high.y; y++) {
                uvec2 row = row_particles(low.x, high.x, y, z);
                for (uint j = row.x; j < row.y; j++) {
                    vec3 d = LOAD_V(position, j).xyz - x;
                    float d2 = dot(d, d), weight = 1.0 - 0.64 * d2 / (k.h * k.h);
                    if (d2 < nearest) {
                        nearest = d2;
                        found = j;
                    }
                    if (weight > 0.0) {
                        weight *= weight * weight;
                        stone += weight * stone_of(j);
                        weighed += weight;
                    }
                }
            }
    }
    vec3 at = clamp((x - vec3(k.origin_x, k.origin_y, k.origin_z)) / k.voxel, vec3(0.0), vec3(k.fx, k.fy, k.fz) - 1.001);
    ivec3 c = ivec3(at);
    vec3 f = at - vec3(c);
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int b = 0; b < 8; b++) {
        ivec3 corner = ivec3(b & 1, (b >> 1) & 1, b >> 2);
        vec3 near = mix(1.0 - f, f, vec3(corner));
        uint brick = LOAD_U(slot, brick_of(c + corner));
        vec4 mean = slot_kept(brick) ? LOAD_V(means, slot_sample(brick, c + corner)) : vec4(0.0);
        float weight = mean.z > 0.0 ? near.x * near.y * near.z : 0.0; // without particles near: 0
        weights += weight;
        sum += weight * mean;
    }
    if (weights > 0.0)
        sum /= weights;
    stone = weighed > 0.0 ? stone / weighed : stone_of(found);
    AT(color, i) += vec4(stone * light_on(LOAD_V(facing, i)), 1.0) / float(k.rays);
    AT(fields, i) = sum;
    AT(ids, 3u * i) = LOAD_U(layer, found);
    AT(ids, 3u * i + 1u) = LOAD_U(phase, found);
    AT(ids, 3u * i + 2u) = found;
}
