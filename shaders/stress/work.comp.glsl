#version 460
#extension GL_GOOGLE_include_directive : require
// Per moving node: its term of b.u, the work of the weight, which is twice the elastic energy once u is the
// solution.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, run)
READ_U(2, table)
READ_V(3, u)
READ_F(4, weight)
WRITE_F(5, product)
PARAMS(stress_params)
#include "stress/grid.glsl"
#include "stress/rows.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(list, i), own = LOAD_U(run, node / STRESS_RUN);
    float weights = 0.0;
    for (int b = 0; b < 4; b++) {
        uint row = row_at(own, node, -(b & 1), -(b >> 1));
        weights += LOAD_F(weight, row);
        weights += LOAD_F(weight, row - 1u);
    }
    AT(product, i) = -weights * k.weight / 8.0 * LOAD_V(u, node).z;
}
