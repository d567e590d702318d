#version 460
#extension GL_GOOGLE_include_directive : require
// Per fragment: sets the bit of the voxel in which it has landed, and counts those that still wait.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, place)
WRITE_U(1, bits)
WRITE_U(2, counts)
PARAMS(deposit_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint p = LOAD_U(place, i);
    if (p == DEPOSIT_WAITS) {
        atomicAdd(AT(counts, COUNT_WAITING), 1u);
    } else if (p != DEPOSIT_LEFT && p != DEPOSIT_HELD) {
        uint v = p - 1u, column = v % (k.nx * k.ny), z = v / (k.nx * k.ny);
        atomicOr(AT(bits, (z >> 5) * k.nx * k.ny + column), 1u << (z & 31u));
    }
}
