#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle at a joint that has just parted two pieces: becomes whole rock of its own side again.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, holds)
WRITE_U(1, joint)
WRITE_F(2, apart)
WRITE_F(3, strength)
PARAMS(mpm_load_params)
#include "mpm/broken.glsl"

void main()
{
    uint i = THREAD;
    uint j = i < k.n ? AT(joint, i) : MPM_NO_JOINT;
    if ((j & PARTED) != 0u || LOAD_U(holds, j) != 2u)
        return;
    AT(joint, i) = j | PARTED;
    AT(apart, i) = MPM_WHOLE;
    AT(strength, i) = k.strength;
}
