#version 460
#extension GL_GOOGLE_include_directive : require
// Per moving node: r = b - K u, the inverse diagonal in r.w, and the node's term of r.z for Jacobi's z = r /
// diagonal. The load b is an eighth of the weight of each of its eight cells, towards -z.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, run)
READ_U(2, table)
READ_V(3, u)
READ_F(4, fill)
READ_F(5, weight)
WRITE_V(6, r)
WRITE_F(7, product)
PARAMS(stress_params)
#include "stress/grid.glsl"
#include "stress/rows.glsl"
#include "stress/apply.glsl"
#include "stress/diagonal.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(list, i), own = LOAD_U(run, node / STRESS_RUN);
    vec4 force = apply_stiffness(node);
    float weights = 0.0;
    for (int b = 0; b < 4; b++) {
        uint row = row_at(own, node, -(b & 1), -(b >> 1));
        weights += LOAD_F(weight, row);
        weights += LOAD_F(weight, row - 1u);
    }
    vec3 residual = vec3(0.0, 0.0, -weights * k.weight / 8.0) - force.xyz;
    float inverse = 1.0 / (diagonal_unit() * force.w);
    AT(r, i) = vec4(residual, inverse);
    AT(product, i) = dot(residual, residual) * inverse;
}
