#version 460
#extension GL_GOOGLE_include_directive : require
// The residual of a coarse level: each of its nodes gathers what the finer level leaves around it, with the
// weights of trilinear interpolation. Finer nodes that do not move hold zero.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, defect)
READ_V(2, r_before)
WRITE_V(3, r)
PARAMS(coarse_params)
#include "stress/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint nx = k.px + 1u, ny = k.py + 1u, node = LOAD_U(list, i);
    ivec3 a = ivec3(node % nx, (node / nx) % ny, node / (nx * ny));
    ivec3 last = ivec3(k.cx, k.cy, k.cz);
    vec3 sum = vec3(0.0);
    for (int z = -1; z <= 1; z++)
        for (int y = -1; y <= 1; y++)
            for (int x = -1; x <= 1; x++) {
                float weight = (2.0 - abs(float(x))) * (2.0 - abs(float(y))) * (2.0 - abs(float(z))) / 8.0;
                sum += weight * LOAD_V(defect, node_index(min(2 * a - 1 + ivec3(x, y, z), last))).xyz;
            }
    AT(r, i) = vec4(sum, LOAD_V(r_before, i).w);
}
