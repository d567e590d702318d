#version 460
#extension GL_GOOGLE_include_directive : require
// Per voxel of the domain: marks rock that does not stand as gone.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, stands)
WRITE_F(1, left)
WRITE_U(2, bits)
PARAMS(voxels_params)
#include "voxels/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n || LOAD_U(stands, i) != 0u)
        return;
    uint v = voxel_bit(i % k.nx, (i / k.nx) % k.ny, i / (k.nx * k.ny));
    if (AT(left, v) > 0.0) {
        AT(left, v) = 0.0;
        atomicOr(AT(bits, v >> 5), 1u << (v & 31u));
    }
}
