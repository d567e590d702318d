#version 460
#extension GL_GOOGLE_include_directive : require
// r = b - K u, the inverse diagonal (in r.w), and r . z for z = r / diagonal. b is the weight of the cells
// around.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, u)
READ_F(2, fill)
WRITE_V(3, r)
WRITE_F(4, product)
PARAMS(stress_params)
#include "stress/grid.glsl"
#include "stress/apply.glsl"
#include "stress/diagonal.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 a = node_of(LOAD_U(list, i));
    vec4 force = apply_stiffness(a);
    float fills = 0.0;
    for (int e = 0; e < 8; e++)
        fills += LOAD_F(fill, cell_index(a - ivec3(e & 1, (e >> 1) & 1, e >> 2)));
    vec3 residual = vec3(0.0, 0.0, -fills * k.weight / 8.0) - force.xyz;
    float inverse = 1.0 / (diagonal_unit() * force.w);
    AT(r, i) = vec4(residual, inverse);
    AT(product, i) = dot(residual, residual) * inverse;
}
