#version 460
#extension GL_GOOGLE_include_directive : require
// Pointers for the sum along receivers: nothing flows in a cavity.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, receiver)
READ_U(1, basin)
READ_U(2, component)
WRITE_U(3, pointer)
PARAMS(water_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    bool flows = i < k.nodes && LOAD_U(component, LOAD_U(basin, i)) == k.basins;
    AT(pointer, i) = flows ? LOAD_U(receiver, i) : k.nodes;
}
