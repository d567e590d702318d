#version 460
#extension GL_GOOGLE_include_directive : require
// Per fragment, in the last round: deposits that slid and have found no cell keep their old voxel, unless
// another fragment has landed in it.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, particle)
READ_V(1, position)
READ_F(2, viability)
WRITE_U(3, place)
WRITE_U(4, bits)
PARAMS(deposit_params)
#include "particles/voxel.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n || AT(place, i) != DEPOSIT_WAITS)
        return;
    uint j = LOAD_U(particle, i);
    if (LOAD_F(viability, j) <= 0.0)
        return;
    ivec3 v = voxel_of(LOAD_V(position, j).xyz);
    uint word = (uint(v.z >> 5) * k.ny + uint(v.y)) * k.nx + uint(v.x), own = 1u << (v.z & 31);
    if ((atomicOr(AT(bits, word), own) & own) == 0u)
        AT(place, i) = DEPOSIT_HELD;
}
