#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle: erodibility *= 1 - binding c, with its cover c.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_F(1, vegetation)
WRITE_F(2, erodibility)
PARAMS(plants_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    float cover = LOAD_F(vegetation, self);
    if (cover > 0.0)
        AT(erodibility, self) *= 1.0 - k.binding * cover;
}
