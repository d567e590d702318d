#version 460
#extension GL_GOOGLE_include_directive : require
// Voxels in which the surface field (field/splat, at the voxel's middle) is inside the rock: what counts as connected is what can
// be seen to be. Threads thinner than a voxel hold nothing. The weights are splat's kernel at distances 0, 1 and sqrt 2; below the
// ground is more of the same.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, fill)
WRITE_U(1, solid)
PARAMS(voxel_params)
#include "particles/voxel.glsl"

float fill_at(ivec3 v)
{
    v.z = max(v.z, 0);
    return voxel_inside(v) ? LOAD_F(fill, voxel_index(v)) : 0.0;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    bool inside = false;
    if (LOAD_F(fill, i) > 0.0) {
        ivec3 v = ivec3(i % k.nx, (i / k.nx) % k.ny, i / (k.nx * k.ny));
        float faces = 0.0, edges = 0.0;
        for (int s = -1; s <= 1; s += 2) {
            faces += fill_at(v + ivec3(s, 0, 0)) + fill_at(v + ivec3(0, s, 0)) + fill_at(v + ivec3(0, 0, s));
            for (int t = -1; t <= 1; t += 2)
                edges += fill_at(v + ivec3(s, t, 0)) + fill_at(v + ivec3(s, 0, t)) + fill_at(v + ivec3(0, s, t));
        }
        inside = 0.196 * LOAD_F(fill, i) + 0.0826 * faces + 0.0245 * edges >= 0.5;
    }
    AT(solid, i) = inside ? 1u : 0u;
}
