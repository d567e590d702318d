#version 460
#extension GL_GOOGLE_include_directive : require
// Which nodes an occupied cell reaches.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, slot)
WRITE_U(1, flags)
PARAMS(mpm_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    // Rows and slabs wrap around, into cells that are never occupied.
    int row = int(k.cx) + 3, slab = row * (int(k.cy) + 3);
    uint any = 0u;
    for (int z = 0; z < 3; z++)
        for (int y = 0; y < 3; y++)
            for (int x = 0; x < 3; x++) {
                int c = int(i) - z * slab - y * row - x;
                any |= c >= 0 ? LOAD_U(slot, c) : 0u;
            }
    AT(flags, i) = any != 0u ? 1u : 0u;
}
