#version 460
#extension GL_GOOGLE_include_directive : require
// Per brick: 1 if a voxel vanished within reach of a bubble; only there do air counts change.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, gone_bricks)
WRITE_U(1, touched)
PARAMS(voxels_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    int x = int(i % k.row), y = int((i / k.row) % k.brick_rows), z = int(i / (k.row * k.brick_rows));
    int r = int(k.reach);
    uint any = 0u;
    for (int dz = max(-r, -z); dz <= min(r, int(k.brick_slabs) - 1 - z); dz++)
        for (int dy = max(-r, -y); dy <= min(r, int(k.brick_rows) - 1 - y); dy++)
            for (int dx = max(-1, -x); dx <= min(1, int(k.row) - 1 - x); dx++)
                any |= LOAD_U(gone_bricks, uint(int(i) + (dz * int(k.brick_rows) + dy) * int(k.row) + dx));
    AT(touched, i) = any;
}
