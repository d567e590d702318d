#version 460
#extension GL_GOOGLE_include_directive : require
// Per source: adds its discharge to all spans on its path of receivers. Integer sums: order does not matter.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, entry)
READ_U(1, source)
READ_U(2, receiver)
WRITE_U(3, spring)
PARAMS(water_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint at = LOAD_U(entry, 2u * i), amount = LOAD_U(source, 4u * i + 3u);
    for (uint step = 0u; step < k.nodes && at < k.nodes && amount > 0u; step++) {
        atomicAdd(AT(spring, at), amount);
        at = LOAD_U(receiver, at);
    }
}
