#version 460
#extension GL_GOOGLE_include_directive : require
// The inverse diagonal of a level's stiffness, in r.w.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_F(1, fill)
WRITE_V(2, r)
PARAMS(stress_params)
#include "stress/diagonal.glsl"
#include "stress/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 a = node_of(LOAD_U(list, i));
    float scales = 0.0;
    for (int e = 0; e < 8; e++)
        scales += stiffness(LOAD_F(fill, cell_index(a - ivec3(e & 1, (e >> 1) & 1, e >> 2))));
    AT(r, i) = vec4(0.0, 0.0, 0.0, 1.0 / (diagonal_unit() * scales));
}
