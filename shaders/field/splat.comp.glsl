#version 460
#extension GL_GOOGLE_include_directive : require
// The rock's share of space around each sample of the field, and the mean of what its particles carry.
//
// share = sum of b h^3 W(|x - x_p|), with W = 315 / (64 pi R^3) (1 - r^2 / R^2)^3: 1 deep inside, and 1/2 on a plane face
// wherever that lies between the particles, since viability b is each one's fill.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
READ_F(1, viability)
READ_F(2, stress)
READ_F(3, von_mises)
READ_U(4, start)
WRITE_F(5, share)
WRITE_V(6, means)
PARAMS(field_params)
#include "particles/voxel.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uvec3 c = uvec3(i % k.fx, (i / k.fx) % k.fy, i / (k.fx * k.fy));
    vec3 x = vec3(k.origin_x, k.origin_y, k.origin_z) + vec3(c) * k.voxel;
    ivec3 low = max(ivec3(floor((x - k.radius) / k.h)), ivec3(0));
    ivec3 high = min(ivec3(floor((x + k.radius) / k.h)), ivec3(k.nx, k.ny, k.nz) - 1);
    float weights = 0.0, filled = 0.0;
    vec3 sum = vec3(0.0);
    if (all(lessThanEqual(low, high)))
        for (int z = low.z; z <= high.z; z++)
            for (int y = low.y; y <= high.y; y++) {
                uint row = voxel_index(ivec3(0, y, z));
                uint end = LOAD_U(start, row + uint(high.x) + 1u);
                for (uint j = LOAD_U(start, row + uint(low.x)); j < end; j++) {
                    vec3 d = (LOAD_V(position, j).xyz - x) / k.radius;
                    float q = max(1.0 - dot(d, d), 0.0);
                    float w = q * q * q, b = LOAD_F(viability, j);
                    weights += w;
                    filled += w * b;
                    sum += w * vec3(LOAD_F(stress, j), LOAD_F(von_mises, j), b);
                }
            }
    float ratio = k.h / k.radius;
    AT(share, i) = filled * (315.0 / (64.0 * 3.14159265)) * ratio * ratio * ratio;
    AT(means, i) = vec4(weights > 0.0 ? sum / weights : vec3(0.0), 0.0);
}
