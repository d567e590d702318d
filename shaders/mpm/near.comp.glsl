#version 460
#extension GL_GOOGLE_include_directive : require
// Per node: 1 if one of the 27 cells that reach it is occupied.
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
    // Indices wrap around rows and slabs into cells that are never occupied.
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
