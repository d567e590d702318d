#version 460
#extension GL_GOOGLE_include_directive : require
// Rubble rests on what it lies on across gaps of up to two voxels, which no field of this resolution closes: the
// empty voxels of such a gap count as solid.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, solid)
READ_U(1, start)
READ_U(2, phase)
WRITE_U(3, bridged)
PARAMS(voxel_params)

bool solid_at(uint x, uint y, int z)
{
    return z < 0 || (uint(z) < k.nz && LOAD_U(solid, (uint(z) * k.ny + y) * k.nx + x) != 0u);
}

bool rubble_at(uint x, uint y, int z)
{
    uint v = (uint(z) * k.ny + y) * k.nx + x, first = LOAD_U(start, v);
    return first < LOAD_U(start, v + 1u) && LOAD_U(phase, first) == PHASE_FALLING;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint x = i % k.nx, y = (i / k.nx) % k.ny;
    int z = int(i / (k.nx * k.ny));
    bool rests = LOAD_U(solid, i) != 0u;
    if (!rests) {
        int above = solid_at(x, y, z + 1) ? 1 : solid_at(x, y, z + 2) ? 2 : 3;
        int below = solid_at(x, y, z - 1) ? 1 : solid_at(x, y, z - 2) ? 2 : 3;
        rests = above + below <= 3 && rubble_at(x, y, z + above);
    }
    AT(bridged, i) = rests ? 1u : 0u;
}
