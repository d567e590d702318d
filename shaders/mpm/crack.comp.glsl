#version 460
#extension GL_GOOGLE_include_directive : require
// Of each joint, how many particles it has and how many of them have cracked.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, joint)
READ_F(1, apart)
WRITE_U(2, count)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    uint j = i < k.n ? LOAD_U(joint, i) : MPM_NO_JOINT;
    if (j == MPM_NO_JOINT)
        return;
    atomicAdd(AT(count, 2u * j), 1u);
    if (LOAD_F(apart, i) >= 0.0)
        atomicAdd(AT(count, 2u * j + 1u), 1u);
}
