#version 460
#extension GL_GOOGLE_include_directive : require
// Per node: its entries, one for each body that reaches it, with a mass and a velocity of their own.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, slot)
READ_U(2, many)
READ_U(3, part_body)
READ_U(4, place)
WRITE_U(5, first)
WRITE_U(6, meeting)
WRITE_U(7, entry_node)
WRITE_U(8, entry_body)
PARAMS(mpm_params)
#include "mpm/bodies.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(list, i), e = i, n = 1u, bodies[MPM_BODIES];
    if (k.bodies != 0u) {
        e = LOAD_U(place, i);
        n = bodies_at(node, bodies);
    } else
        bodies[0] = 0u;
    AT(first, node) = e;
    AT(meeting, node) = n;
    for (uint b = 0u; b < n; b++) {
        AT(entry_node, e + b) = node;
        AT(entry_body, e + b) = bodies[b];
    }
}
