#version 460
#extension GL_GOOGLE_include_directive : require
// A coarse level's correction added to the finer level's, by trilinear interpolation.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, coarse)
READ_V(2, z_before)
WRITE_V(3, z)
PARAMS(coarse_params)
#include "stress/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(list, i);
    ivec3 a = node_of(node);
    ivec3 low = (a + 1) / 2, high = (a + 2) / 2; // the same where the nodes coincide
    vec3 sum = vec3(0.0);
    for (int b = 0; b < 8; b++) {
        ivec3 at = ivec3((b & 1) == 0 ? low.x : high.x, (b & 2) == 0 ? low.y : high.y, (b & 4) == 0 ? low.z : high.z);
        sum += LOAD_V(coarse, (uint(at.z) * (k.py + 1u) + uint(at.y)) * (k.px + 1u) + uint(at.x)).xyz;
    }
    AT(z, node) = vec4(LOAD_V(z_before, node).xyz + sum / 8.0, 0.0);
}
