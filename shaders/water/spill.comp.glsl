#version 460
#extension GL_GOOGLE_include_directive : require
// Per basin: the altitude of the pass over which it overflows, and the basin beyond. The last basin is the
// outside.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, component)
READ_U(1, from)
READ_U(2, to)
READ_U(3, basin)
READ_U(4, altitude)
WRITE_U(5, spill)
WRITE_U(6, next)
PARAMS(water_params)

void main()
{
    uint b = THREAD;
    if (b >= k.n)
        return;
    bool live = b < k.basins && LOAD_U(component, b) == k.basins;
    uint i = live ? LOAD_U(from, b) : 0u, j = live ? LOAD_U(to, b) : 0u;
    AT(spill, b) = live ? max(LOAD_U(altitude, i), LOAD_U(altitude, j)) : 0u;
    AT(next, b) = live ? LOAD_U(basin, j) : k.basins;
}
