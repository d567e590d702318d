#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: counts, for each joint, its particles and those that have cracked, or flags that it has parted
// already; and for each piece its particles that are not loose.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, joint)
READ_F(1, apart)
READ_U(2, piece)
WRITE_U(3, count)
PARAMS(mpm_load_params)
#include "mpm/broken.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint j = LOAD_U(joint, i);
    bool cracked = LOAD_F(apart, i) >= 0.0;
    if (!is_loose(LOAD_F(apart, i), j))
        atomicAdd(AT(count, 2u * MPM_JOINTS * k.pieces + LOAD_U(piece, i) - 1u), 1u);
    if (j == MPM_NO_JOINT)
        return;
    if ((j & PARTED) != 0u) {
        atomicOr(AT(count, 2u * (j - PARTED) + 1u), PARTED);
        return;
    }
    atomicAdd(AT(count, 2u * j), 1u);
    if (cracked)
        atomicAdd(AT(count, 2u * j + 1u), 1u);
}
