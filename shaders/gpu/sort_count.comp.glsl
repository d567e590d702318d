#version 460
#extension GL_GOOGLE_include_directive : require
// Per item, counting sort: counts the items of each key.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, keys)
WRITE_U(1, counts)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        atomicAdd(AT(counts, LOAD_U(keys, i)), 1u);
}
