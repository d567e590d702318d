#version 460
#extension GL_GOOGLE_include_directive : require
// Viability of the surface falls by erodibility times intensity (Arenite eqs. 1, 7, 8, 12), in retreat over
// the spacing.
//
// Rock vanishes voxel by voxel over its faces, so that a slanted front would retreat at max |n_i| of the
// rate: the division by it makes the retreat the same in every direction. What a particle did not need of its
// step is left in `unspent` for those behind it (erosion/carry).
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_V(2, normal)
READ_F(3, stress)
READ_F(4, erodibility)
READ_U(5, start)
WRITE_F(6, viability)
WRITE_F(7, unspent)
WRITE_U(8, counts)
PARAMS(erosion_params)
#include "particles/voxel.glsl"

float deflation(float t)
{
    float pull = max(0.0, k.cohesion + k.friction * t);
    return k.deflation * exp(-(pull * pull - k.cohesion * k.cohesion) / (2.0 * k.strength * k.strength));
}

// 1 if the wind reaches x, 0 if rock stands upwind within the sheltering distance. The first steps leave the
// particle's own bump.
float reached_by_wind(vec3 x, vec3 n)
{
    vec3 wind = vec3(k.wind_x, k.wind_y, k.wind_z), at = x + 1.5 * k.h * n - 0.5 * k.h * wind;
    int steps = int(k.shelter / k.h);
    for (int s = 0; s < steps; s++) {
        ivec3 v = ivec3(floor(at / k.h));
        if (!voxel_inside(v))
            return v.z < 0 ? 0.0 : 1.0;
        uint c = voxel_index(v);
        if (LOAD_U(start, c) != LOAD_U(start, c + 1u))
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
    float rate = LOAD_F(erodibility, self);
    if (rate <= 0.0)
        return;
    vec3 n = LOAD_V(normal, self).xyz;
    float against = -dot(n, vec3(k.wind_x, k.wind_y, k.wind_z));
    float intensity = deflation(LOAD_F(stress, self));
    if (k.abrasion > 0.0 && against > 0.0)
        intensity += k.abrasion * against * reached_by_wind(LOAD_V(position, self).xyz, n);
    float step = intensity * k.dt / (k.h * max(abs(n.x), max(abs(n.y), abs(n.z))));
    float before = AT(viability, self), after = before - rate * step;
    if (after <= 0.0) {
        AT(unspent, self) = step * (-after / (before - after));
        atomicAdd(AT(counts, COUNT_ERODED), 1u);
        after = 0.0;
    }
    AT(viability, self) = after;
}
