#version 460
#extension GL_GOOGLE_include_directive : require
// A coarse cell's share of the full stiffness: the mean of its eight children's.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, run)
READ_U(1, table)
READ_F(2, fill)
WRITE_F(3, coarse)
PARAMS(coarse_params)
#include "stress/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint own = LOAD_U(run, i / STRESS_RUN);
    uvec3 above = uvec3(k.px, k.py, k.pz);
    ivec3 c = node_of(own, i, above);
    float sum = 0.0;
    if (own != STRESS_NO_RUN && all(greaterThanEqual(c, ivec3(1))) && all(lessThan(c, ivec3(above) - 1)))
        for (int b = 0; b < 4; b++) {
            ivec3 child = 2 * c - 1 + ivec3(0, b & 1, b >> 1);
            uint row = LOAD_U(table, run_of(child, uvec3(k.cx, k.cy, k.cz))) + uint(child.x) % STRESS_RUN;
            sum += stiffness(LOAD_F(fill, row));
            sum += stiffness(LOAD_F(fill, row + 1u));
        }
    AT(coarse, i) = sum / 8.0;
}
