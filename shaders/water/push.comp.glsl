#version 460
#extension GL_GOOGLE_include_directive : require
// One round of summing along receivers: each span gives what it has gathered so far, from ever farther
// upstream, to the span its pointer has reached, and doubles the pointer. `sum` begins as a copy of
// `gathered`; sums of integers do not depend on order.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, pointer)
READ_U(1, gathered)
WRITE_U(2, sum)
WRITE_U(3, to)
WRITE_U(4, counts)
PARAMS(water_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint at = LOAD_U(pointer, i), beyond = LOAD_U(pointer, at);
    if (beyond == at) // what has no way out, between walls on all sides, stays in its pit
        beyond = k.nodes;
    AT(to, i) = beyond;
    if (at == k.nodes || at == i)
        return;
    uint own = LOAD_U(gathered, i);
    if (own != 0u)
        atomicAdd(AT(sum, at), own);
    if (beyond != k.nodes)
        AT(counts, COUNT_CHANGED) = 1u;
}
