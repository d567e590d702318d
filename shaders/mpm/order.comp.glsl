#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: its rank among those of its cell, by group, then by id. Particles that are gone come last, in
// any order.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, keys)
READ_U(1, start)
READ_U(2, unordered)
READ_U(3, group)
READ_U(4, ids)
WRITE_U(5, order)
PARAMS(sort_params)

void main()
{
    uint slot = THREAD;
    if (slot >= k.n)
        return;
    uint i = LOAD_U(unordered, slot), key = LOAD_U(keys, i), first = LOAD_U(start, key);
    uint end = LOAD_U(start, key + 1u), rank = slot - first;
    if (key < k.n_ordered && end - first > 1u) {
        uint own = LOAD_U(group, i), id = LOAD_U(ids, i);
        rank = 0u;
        for (uint s = first; s < end; s++) {
            uint j = LOAD_U(unordered, s), g = LOAD_U(group, j);
            rank += g < own || (g == own && LOAD_U(ids, j) < id) ? 1u : 0u;
        }
    }
    AT(order, first + rank) = i;
}
