#version 460
#extension GL_GOOGLE_include_directive : require
// Per moving node: its term of r.z, with z from the multigrid cycle.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, r)
READ_V(2, z)
WRITE_F(3, product)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(product, i) = dot(LOAD_V(r, i).xyz, LOAD_V(z, LOAD_U(list, i)).xyz);
}
