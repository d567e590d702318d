#version 460
#extension GL_GOOGLE_include_directive : require
// How T and von Mises stress change across a cell, Pa a cell: the plane that fits the cells around best, each weighted
// by its rock. It is held level where there are too few cells to tell, as across a member one cell wide.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, fill)
READ_V(1, normal_stress)
READ_V(2, shear_stress)
WRITE_V(3, t_slope)
WRITE_V(4, mises_slope)
PARAMS(stress_params)
#include "stress/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n || LOAD_F(fill, i) == 0.0)
        return;
    ivec3 c = ivec3(i % k.cx, (i / k.cx) % k.cy, i / (k.cx * k.cy));
    float weights = 0.0;
    vec3 middle = vec3(0.0);
    vec2 mean = vec2(0.0), own = vec2(LOAD_V(normal_stress, i).w, LOAD_V(shear_stress, i).w);
    mat3 spread = mat3(0.25); // what holds it level
    mat2x3 along = mat2x3(0.0);
    for (int z = -1; z <= 1; z++)
        for (int y = -1; y <= 1; y++)
            for (int x = -1; x <= 1; x++) {
                uint at = cell_index(c + ivec3(x, y, z));
                float weight = LOAD_F(fill, at);
                vec3 d = vec3(x, y, z);
                vec2 more = vec2(LOAD_V(normal_stress, at).w, LOAD_V(shear_stress, at).w) - own;
                weights += weight;
                middle += weight * d;
                mean += weight * more;
                spread += outerProduct(weight * d, d);
                along += outerProduct(weight * d, more);
            }
    spread -= outerProduct(middle / weights, middle);
    along -= outerProduct(middle / weights, mean);
    mat2x3 slope = inverse(spread) * along;
    AT(t_slope, i) = vec4(slope[0], 0.0);
    AT(mises_slope, i) = vec4(slope[1], 0.0);
}
