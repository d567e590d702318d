#version 460
#extension GL_GOOGLE_include_directive : require
// Per voxel of the domain, one round: weathered rock (less than half left) stands if a face neighbour stands.
// Voxels only gain support, so the final state does not depend on the order.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, left)
READ_U(1, solid)
WRITE_U(2, stands)
WRITE_U(3, flags)
PARAMS(voxels_params)
#include "voxels/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n || AT(stands, i) != 0u || LOAD_U(solid, i) != 0u)
        return;
    uint x = i % k.nx, y = (i / k.nx) % k.ny, z = i / (k.nx * k.ny), slab = k.nx * k.ny;
    if (LOAD_F(left, voxel_bit(x, y, z)) <= 0.0)
        return;
    bool held = (x > 0u && AT(stands, i - 1u) == 1u) || (x + 1u < k.nx && AT(stands, i + 1u) == 1u) ||
                (y > 0u && AT(stands, i - k.nx) == 1u) || (y + 1u < k.ny && AT(stands, i + k.nx) == 1u) ||
                (z > 0u && AT(stands, i - slab) == 1u) || (z + 1u < k.nz && AT(stands, i + slab) == 1u);
    if (held) {
        AT(stands, i) = 1u;
        AT(flags, k.flag) = 1u;
    }
}
