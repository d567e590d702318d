#version 460
#extension GL_GOOGLE_include_directive : require
// Per item: its rank among those of its key, the number of them with a smaller id. So the order does not depend
// on that of the scatter.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, keys)
READ_U(1, start)
READ_U(2, unordered)
READ_U(3, ids)
WRITE_U(4, order)
PARAMS(sort_params)

void main()
{
    uint slot = THREAD;
    if (slot >= k.n)
        return;
    uint i = LOAD_U(unordered, slot), key = LOAD_U(keys, i), first = LOAD_U(start, key);
    uint end = LOAD_U(start, key + 1u), rank = slot - first;
    if (key < k.n_ordered && end - first > 1u) {
        uint id = LOAD_U(ids, i);
        rank = 0u;
        for (uint j = first; j < end; j++)
            rank += LOAD_U(ids, LOAD_U(unordered, j)) < id ? 1u : 0u;
    }
    AT(order, first + rank) = i;
}
