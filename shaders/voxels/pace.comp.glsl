#version 460
#extension GL_GOOGLE_include_directive : require
// Per thread, over every VOXELS_PACERS-th active voxel: time until the first vanishes, and the fastest rate.
// The host reduces the threads' results.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, state)
READ_F(2, left)
READ_V(3, layers)
READ_U(4, layer_of)
WRITE_F(5, paces)
PARAMS(voxels_params)
#include "voxels/grid.glsl"
#include "voxels/layer.glsl"
#include "voxels/rate.glsl"

void main()
{
    if (THREAD >= VOXELS_PACERS)
        return;
    float event = 1e30, fastest = 0.0;
    for (uint i = THREAD; i < k.n; i += VOXELS_PACERS) {
        uint v = LOAD_U(list, i);
        float rate = decimation(LOAD_U(state, v), v);
        fastest = max(fastest, rate);
        event = min(event, rate > 0.0 ? LOAD_F(left, v) / rate : 1e30);
    }
    AT(paces, 2u * THREAD) = event;
    AT(paces, 2u * THREAD + 1u) = fastest;
}
