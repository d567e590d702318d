#version 460
#extension GL_GOOGLE_include_directive : require
// Per basin: maximum pass altitude on its way out, by pointer doubling.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, spill)
READ_U(1, next)
WRITE_U(2, farther)
WRITE_U(3, beyond)
PARAMS(water_params)

void main()
{
    uint b = THREAD;
    if (b >= k.n)
        return;
    uint to = LOAD_U(next, b);
    AT(farther, b) = max(LOAD_U(spill, b), LOAD_U(spill, to));
    AT(beyond, b) = LOAD_U(next, to);
}
