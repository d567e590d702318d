#version 460
#extension GL_GOOGLE_include_directive : require
// Per moving node of the coarse level: r = P^T d, the finer level's defects around it with the weights of
// trilinear interpolation. Defects of nodes that do not move are zero.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, run)
READ_U(2, table)
READ_V(3, defect)
READ_V(4, r_before)
WRITE_V(5, r)
PARAMS(coarse_params)
#include "stress/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(list, i);
    ivec3 a = node_of(LOAD_U(run, node / STRESS_RUN), node, uvec3(k.px, k.py, k.pz));
    ivec3 last = ivec3(k.cx, k.cy, k.cz);
    vec3 sum = vec3(0.0);
    for (int z = -1; z <= 1; z++)
        for (int y = -1; y <= 1; y++) {
            ivec3 middle = min(2 * a - 1 + ivec3(0, y, z), last);
            int row = int(LOAD_U(table, run_of(middle, uvec3(last))) + uint(middle.x) % STRESS_RUN);
            for (int x = -1; x <= 1; x++) {
                float weight = (2.0 - abs(float(x))) * (2.0 - abs(float(y))) * (2.0 - abs(float(z))) / 8.0;
                sum += weight * LOAD_V(defect, row + x).xyz;
            }
        }
    sum = along_walls(sum, a, ivec3(k.px, k.py, k.pz), k.walls);
    AT(r, i) = vec4(sum, LOAD_V(r_before, i).w);
}
