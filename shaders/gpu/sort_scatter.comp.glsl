#version 460
#extension GL_GOOGLE_include_directive : require
// Per item: puts it into any free place of its key; sort_rank then orders them.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, keys)
READ_U(1, start)
WRITE_U(2, taken)
WRITE_U(3, unordered)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint key = LOAD_U(keys, i);
    AT(unordered, LOAD_U(start, key) + atomicAdd(AT(taken, key), 1u)) = i;
}
