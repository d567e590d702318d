#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle of rock in the first frame: age = skin.before_kyr.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, phase)
WRITE_F(2, exposed)
PARAMS(skin_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    if (LOAD_U(phase, self) != PHASE_DEPOSIT)
        AT(exposed, self) = k.kyr;
}
