#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle: the wind's intensity W = W_d + W_a (Arenite eqs. 7, 8, 12), with W_a from the averaged
// air around the rock.
//
// Blown grains need some metres to adapt to the air's motion: they strike with the velocity that the air has
// `shelter` metres off the surface, or one spacing of the air if that is more. From there on the average is
// within a few hundredths of potential flow in front of a sphere; nearer, the kernel reaches only air that is
// farther out. In a gap narrower than that, the velocity is sampled at its middle.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_V(2, normal)
READ_F(3, stress)
READ_U(4, words)
READ_V(5, air)
READ_U(6, layer)
READ_V(7, layers)
WRITE_F(8, intensity)
WRITE_U(9, parts) // the processes' shares
PARAMS(wind_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/empty.glsl"
#include "erosion/layer.glsl"
#include "erosion/parts.glsl"
#include "wind/deflation.glsl"

vec3 air_at(ivec3 c)
{
    c = clamp(c, ivec3(0), ivec3(k.bx, k.by, k.bz) - 1);
    return LOAD_V(air, (uint(c.z) * k.by + uint(c.y)) * k.bx + uint(c.x)).xyz;
}

vec3 air_between(ivec3 c, vec3 f)
{
    vec3 low = mix(mix(air_at(c), air_at(c + ivec3(1, 0, 0)), f.x),
                   mix(air_at(c + ivec3(0, 1, 0)), air_at(c + ivec3(1, 1, 0)), f.x), f.y);
    c.z++;
    vec3 high = mix(mix(air_at(c), air_at(c + ivec3(1, 0, 0)), f.x),
                    mix(air_at(c + ivec3(0, 1, 0)), air_at(c + ivec3(1, 1, 0)), f.x), f.y);
    return mix(low, high, f.z);
}

// How far along the normal the velocity is sampled, m. The march starts 1.5 voxels off the surface, clear of the particle's own
// roughness.
float clear_way(vec3 x, vec3 n)
{
    float most = max(k.shelter, k.cell);
    for (float s = 1.5 * k.h; s < most; s += k.h)
        if (!voxel_empty(ivec3(floor((x + s * n) / k.h))))
            return 0.5 * s;
    return most;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    vec3 x = LOAD_V(position, self).xyz, n = LOAD_V(normal, self).xyz;
    vec3 at = (x + clear_way(x, n) * n - vec3(k.origin_x, k.origin_y, 0.0)) / k.cell - 0.5;
    vec3 v = air_between(ivec3(floor(at)), fract(at));
    vec4 own = layer_weather(LOAD_U(layer, self));
    float plucked = deflation(LOAD_F(stress, self), own), sum = plucked + abrasion(own) * length(v) * max(0.0, -dot(n, v));
    AT(intensity, i) = sum;
    AT(parts, i) = parts_of(sum > 0.0 ? plucked / sum : 0.0, 0.0);
}
