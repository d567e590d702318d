#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle: the wind's intensity W = W_d + W_a (Arenite eqs. 7, 8, 12) where the wind is uniform.
// W_a is 0 if rock stands upwind within the sheltering distance.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_V(2, normal)
READ_F(3, stress)
READ_U(4, words)
READ_U(5, layer)
READ_V(6, layers)
WRITE_F(7, intensity)
WRITE_U(8, parts) // the processes' shares
PARAMS(wind_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/empty.glsl"
#include "erosion/layer.glsl"
#include "erosion/parts.glsl"
#include "wind/deflation.glsl"

// 1 if the wind reaches x, 0 if there is rock upwind within the sheltering distance. The march starts 1.5 voxels off the
// surface, clear of the particle's own roughness.
float reached_by_wind(vec3 x, vec3 n)
{
    vec3 wind = vec3(k.wind_x, k.wind_y, k.wind_z), at = x + 1.5 * k.h * n - 0.5 * k.h * wind;
    int steps = int(k.shelter / k.h);
    for (int s = 0; s < steps; s++) {
        ivec3 v = side_voxel(ivec3(floor(at / k.h)));
        if (!voxel_inside(v))
            return v.z < 0 ? 0.0 : 1.0;
        if (!voxel_empty(v))
            return 0.0;
        at -= k.h * wind;
    }
    return 1.0;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    vec3 x = LOAD_V(position, self).xyz, n = LOAD_V(normal, self).xyz;
    float against = -dot(n, vec3(k.wind_x, k.wind_y, k.wind_z));
    vec4 own = layer_weather(LOAD_U(layer, self));
    float plucked = deflation(LOAD_F(stress, self), own), sum = plucked;
    float rubbed = abrasion(own);
    if (rubbed > 0.0 && against > 0.0)
        sum += rubbed * against * reached_by_wind(x, n);
    AT(intensity, i) = sum;
    AT(parts, i) = parts_of(sum > 0.0 ? plucked / sum : 0.0, 0.0);
}
