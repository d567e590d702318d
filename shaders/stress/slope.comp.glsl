#version 460
#extension GL_GOOGLE_include_directive : require
// Per cell with fill: gradient of T and of the von Mises stress, in Pa per cell: least-squares plane through
// the 27 cells around it, weighted by fill. A regularisation of 1/4 keeps the plane level across members of one
// cell, where the cells do not determine it.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, run)
READ_U(1, table)
READ_F(2, fill)
READ_V(3, normal_stress)
READ_V(4, shear_stress)
WRITE_V(5, t_slope)
WRITE_V(6, mises_slope)
PARAMS(stress_params)
#include "stress/grid.glsl"
#include "stress/rows.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n || LOAD_F(fill, i) == 0.0)
        return;
    uint own = LOAD_U(run, i / STRESS_RUN);
    float weights = 0.0;
    vec3 middle = vec3(0.0);
    vec2 mean = vec2(0.0), here = vec2(LOAD_V(normal_stress, i).w, LOAD_V(shear_stress, i).w);
    mat3 spread = mat3(0.25); // regularisation
    mat2x3 along = mat2x3(0.0);
    // Beyond a wall lies the mirror image: the neighbour of a cell at the wall is the cell itself.
    ivec3 before = ivec3(-1), behind = ivec3(1);
    if (k.walls != 0u) {
        ivec3 c = node_of(own, i, CELLS);
        before = side_cell(c - 1) - c;
        behind = side_cell(c + 1) - c;
        before.z = -1;
        behind.z = 1;
    }
    for (int z = -1; z <= 1; z++)
        for (int y = -1; y <= 1; y++) {
            uint row = row_at(own, i, clamp(y, before.y, behind.y), z);
            for (int x = -1; x <= 1; x++) {
                uint at = row + uint(clamp(x, before.x, behind.x));
                float weight = abs(LOAD_F(fill, at));
                vec3 d = vec3(x, y, z);
                vec2 more = vec2(LOAD_V(normal_stress, at).w, LOAD_V(shear_stress, at).w) - here;
                weights += weight;
                middle += weight * d;
                mean += weight * more;
                spread += outerProduct(weight * d, d);
                along += outerProduct(weight * d, more);
            }
        }
    spread -= outerProduct(middle / weights, middle);
    along -= outerProduct(middle / weights, mean);
    mat2x3 slope = inverse(spread) * along;
    AT(t_slope, i) = vec4(slope[0], 0.0);
    AT(mises_slope, i) = vec4(slope[1], 0.0);
}
