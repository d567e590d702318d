#version 460
#extension GL_GOOGLE_include_directive : require
// Which deep voxels get their particles: those near the surface. Counts them.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, near)
READ_U(1, deep)
WRITE_U(2, born)
WRITE_U(3, counts)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint bits = LOAD_U(near, i) & LOAD_U(deep, i);
    AT(born, i) = bits;
    if (bits != 0u)
        atomicAdd(AT(counts, COUNT_BORN), uint(bitCount(bits)));
}
