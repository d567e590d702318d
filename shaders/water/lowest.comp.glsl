#version 460
#extension GL_GOOGLE_include_directive : require
// Per border span: minimum, for each component of basins, of the altitude of its passes to other components.
// Integer minima: order does not matter.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, border)
READ_U(1, pass)
READ_U(2, basin)
READ_U(3, component)
READ_U(4, altitude)
WRITE_U(5, lowest)
PARAMS(water_params)

void offer(uint c, uint z)
{
    if (c != k.basins && AT(lowest, c) > z)
        atomicMin(AT(lowest, c), z);
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
            offer(own, w);
            offer(other, w);
        }
    }
}
