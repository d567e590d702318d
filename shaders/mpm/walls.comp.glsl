#version 460
#extension GL_GOOGLE_include_directive : require
// Per node: whether it is inside resting rock, and the outward normal there. Faces of resting rock act on
// single particles (gather.comp.glsl), so that bodies touch what they rest on.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, words)
READ_F(2, fill)
WRITE_V(3, wall)
PARAMS(mpm_params)
#include "mpm/grid.glsl"
#include "mpm/voxels.glsl"
#include "particles/held.glsl"
#include "particles/fill.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(list, i);
    ivec3 corner = 2 * (mpm_at(node) - 1) - ivec3(0, 0, int(2.0 * k.lift));
    float inside = 0.0;
    vec3 inward = vec3(0.0);
    for (int z = -2; z < 2; z++)
        for (int y = -2; y < 2; y++)
            for (int x = -2; x < 2; x++) {
                float rock = fill_at(corner + ivec3(x, y, z));
                vec3 d = vec3(x, y, z) + 0.5;
                inward += rock * d;
                inside += x >= -1 && x < 1 && y >= -1 && y < 1 && z >= -1 && z < 1 ? rock : 0.0;
            }
    float size = length(inward);
    AT(wall, node) = inside >= 7.0 ? vec4(size > 0.1 ? -inward / size : vec3(0.0, 0.0, 1.0), 1.0) : vec4(0.0);
}
