#version 460
#extension GL_GOOGLE_include_directive : require
// Per border span: of each component's lowest passes, the one with the smallest number.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, border)
READ_U(1, pass)
READ_U(2, basin)
READ_U(3, component)
READ_U(4, altitude)
READ_U(5, lowest)
WRITE_U(6, pick)
PARAMS(water_params)

void offer(uint c, uint z, uint number)
{
    if (c != k.basins && LOAD_U(lowest, c) == z && AT(pick, c) > number)
        atomicMin(AT(pick, c), number);
}

void main()
{
    uint b = THREAD;
    if (b >= k.n)
        return;
    uint i = LOAD_U(border, b), own = LOAD_U(component, LOAD_U(basin, i)), z = LOAD_U(altitude, i);
    for (uint d = 0u; d < 4u; d++) {
        uint m = LOAD_U(pass, 4u * i + d);
        if (m == 0xffffffffu)
            continue;
        uint other = LOAD_U(component, LOAD_U(basin, m));
        if (other != own) {
            uint w = max(z, LOAD_U(altitude, m));
            offer(own, w, 4u * i + d);
            offer(other, w, 4u * i + d);
        }
    }
}
