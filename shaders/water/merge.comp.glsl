#version 460
#extension GL_GOOGLE_include_directive : require
// Per basin: moves it to the component that its own was joined to, and clears the passes.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, next)
WRITE_U(1, component)
WRITE_U(2, lowest)
WRITE_U(3, pick)
PARAMS(water_params)

void main()
{
    uint b = THREAD;
    if (b >= k.n)
        return;
    AT(component, b) = LOAD_U(next, AT(component, b));
    AT(lowest, b) = 0xffffffffu;
    AT(pick, b) = 0xffffffffu;
}
