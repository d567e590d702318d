#version 460
#extension GL_GOOGLE_include_directive : require
// Per basin with a way out: reverses the receivers from its pass down to its pit, so that the basin overflows
// across the pass. Paths of different basins do not touch.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, component)
READ_U(1, from)
READ_U(2, to)
READ_U(3, initial)
WRITE_U(4, receiver)
PARAMS(water_params)

void main()
{
    uint b = THREAD;
    if (b >= k.n || LOAD_U(component, b) != k.basins)
        return;
    uint at = LOAD_U(from, b), previous = LOAD_U(to, b);
    for (uint step = 0u; step < k.nodes; step++) {
        uint next = LOAD_U(initial, at);
        AT(receiver, at) = previous;
        if (next == at)
            break;
        previous = at;
        at = next;
    }
}
