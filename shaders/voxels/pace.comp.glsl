#version 460
#extension GL_GOOGLE_include_directive : require
// When the next voxel vanishes, and how long the fastest lives from whole to gone. Minima of positive floats
// as their bits: in whatever order, the same.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, state)
READ_F(2, left)
READ_V(3, layers)
READ_U(4, layer_of)
WRITE_U(5, words)
PARAMS(voxels_params)
#include "voxels/grid.glsl"
#include "voxels/rate.glsl"

void main()
{
    float event = 1e30, fastest = 0.0;
    for (uint i = THREAD; i < k.n; i += VOXELS_PACERS) {
        uint v = LOAD_U(list, i);
        float rate = decimation(LOAD_U(state, v), slab_of(v));
        fastest = max(fastest, rate);
        event = min(event, rate > 0.0 ? LOAD_F(left, v) / rate : 1e30);
    }
    if (fastest > 0.0) {
        atomicMin(AT(words, VOXELS_EVENT), floatBitsToUint(event));
        atomicMin(AT(words, VOXELS_LIFE), floatBitsToUint(1.0 / fastest));
    }
}
