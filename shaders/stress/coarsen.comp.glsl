#version 460
#extension GL_GOOGLE_include_directive : require
// Per coarse cell: stiffness share = mean over its eight children; negative where a child's is (deposits or
// joints). For whole cells and trilinear interpolation this is the Galerkin product R K P.
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
    bool loose = false;
    if (own != STRESS_NO_RUN && all(greaterThanEqual(c, ivec3(1))) && all(lessThan(c, ivec3(above) - 1)))
        for (int b = 0; b < 4; b++) {
            ivec3 child = 2 * c - 1 + ivec3(0, b & 1, b >> 1);
            uint row = LOAD_U(table, run_of(child, uvec3(k.cx, k.cy, k.cz))) + uint(child.x) % STRESS_RUN;
            float low = LOAD_F(fill, row), high = LOAD_F(fill, row + 1u);
            sum += stiffness(low);
            sum += stiffness(high);
            loose = loose || low < 0.0 || high < 0.0;
        }
    AT(coarse, i) = loose ? -sum / 8.0 : sum / 8.0;
}
