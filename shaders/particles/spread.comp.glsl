#version 460
#extension GL_GOOGLE_include_directive : require
// Per held voxel: fill where particles have left the centres of their voxels: each is distributed to the eight
// voxels around it by trilinear weights, so that the surface does not flicker while rock moves.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
READ_U(1, start)
READ_U(2, list)
READ_V(3, position)
READ_F(4, viability)
WRITE_F(5, fill)
PARAMS(voxel_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 v = voxel_at(LOAD_U(list, i));
    // What would be below the ground or beyond a wall stays in the voxel on this side.
    vec3 least = vec3((k.walls & WALL_X_MIN) != 0u ? 0.0 : -1e9, (k.walls & WALL_Y_MIN) != 0u ? 0.0 : -1e9, 0.0);
    vec3 most = vec3((k.walls & WALL_X_MAX) != 0u ? float(k.nx) - 1.0 : 1e9,
                     (k.walls & WALL_Y_MAX) != 0u ? float(k.ny) - 1.0 : 1e9, 1e9);
    ivec3 low = max(v - 1, ivec3(0)), high = min(v + 1, ivec3(k.nx, k.ny, k.nz) - 1);
    float sum = 0.0;
    for (int z = low.z; z <= high.z; z++)
        for (int y = low.y; y <= high.y; y++) {
            uvec2 row = row_particles(low.x, high.x, y, z);
            for (uint j = row.x; j < row.y; j++) {
                vec3 x = LOAD_V(position, j).xyz / k.h - 0.5;
                vec3 w = max(1.0 - abs(clamp(x, least, most) - vec3(v)), vec3(0.0));
                sum += w.x * w.y * w.z * LOAD_F(viability, j);
            }
        }
    AT(fill, i) = min(sum, 1.0);
}
