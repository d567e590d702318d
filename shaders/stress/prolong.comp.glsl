#version 460
#extension GL_GOOGLE_include_directive : require
// Per moving node of the finer level: z += P z_coarse, trilinear interpolation of the coarse level's
// correction.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, run)
READ_U(2, table)
READ_V(3, coarse)
READ_V(4, z_before)
WRITE_V(5, z)
PARAMS(coarse_params)
#include "stress/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(list, i);
    ivec3 a = node_of(LOAD_U(run, node / STRESS_RUN), node, uvec3(k.cx, k.cy, k.cz));
    ivec3 low = (a + 1) / 2, high = (a + 2) / 2; // equal where the nodes coincide
    vec3 sum = vec3(0.0);
    for (int b = 0; b < 4; b++) {
        ivec3 at = ivec3(low.x, (b & 1) == 0 ? low.y : high.y, b < 2 ? low.z : high.z);
        uint row = LOAD_U(table, run_of(at, uvec3(k.px, k.py, k.pz))) + uint(low.x) % STRESS_RUN;
        sum += LOAD_V(coarse, row).xyz;
        sum += LOAD_V(coarse, row + uint(high.x - low.x)).xyz;
    }
    sum = along_walls(sum, a, ivec3(k.cx, k.cy, k.cz), k.walls);
    AT(z, node) = vec4(LOAD_V(z_before, node).xyz + sum / 8.0, 0.0);
}
