#version 460
#extension GL_GOOGLE_include_directive : require
// Each column's runs of rock are blocks to begin with: their voxels point to the lowest. Empty voxels point
// to themselves.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, solid)
WRITE_U(1, pointer)
PARAMS(voxel_params)

void main()
{
    uint column = THREAD;
    if (column >= k.n)
        return;
    uint layer = k.nx * k.ny, lowest = column;
    bool inside = false;
    for (uint z = 0u; z < k.nz; z++) {
        uint v = z * layer + column;
        bool rock = LOAD_U(solid, v) != 0u;
        if (!rock || !inside)
            lowest = v;
        AT(pointer, v) = lowest;
        inside = rock;
    }
}
