#version 460
#extension GL_GOOGLE_include_directive : require
// Per active voxel, first step of a cycle: left -= dt rate, and marks it as gone if nothing is left, or if the
// rest would be gone soon. The rock bits change only in the second step, so the update is synchronous.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, state)
READ_V(2, layers)
READ_U(3, layer_of)
WRITE_F(4, left)
WRITE_U(5, bits)
PARAMS(voxels_params)
#include "voxels/grid.glsl"
#include "voxels/layer.glsl"
#include "voxels/rate.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint v = LOAD_U(list, i);
    float rate = decimation(LOAD_U(state, v), v), after = AT(left, v) - k.dt * rate;
    if (after <= max(k.early * rate, VOXELS_SLIVER)) {
        atomicOr(AT(bits, v >> 5), 1u << (v & 31u));
        after = 0.0;
    }
    AT(left, v) = after;
}
