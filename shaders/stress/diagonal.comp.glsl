#version 460
#extension GL_GOOGLE_include_directive : require
// Per moving node of a coarse level: r = 0, and the inverse diagonal of K in r.w.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, run)
READ_U(2, table)
READ_F(3, fill)
WRITE_V(4, r)
PARAMS(stress_params)
#include "stress/diagonal.glsl"
#include "stress/grid.glsl"
#include "stress/rows.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(list, i), own = LOAD_U(run, node / STRESS_RUN);
    float scales = 0.0;
    for (int b = 0; b < 4; b++) {
        uint row = row_at(own, node, -(b & 1), -(b >> 1));
        scales += stiffness(LOAD_F(fill, row));
        scales += stiffness(LOAD_F(fill, row - 1u));
    }
    AT(r, i) = vec4(0.0, 0.0, 0.0, 1.0 / (diagonal_unit() * scales));
}
