#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: a particle that was bared and covered again by a deposit before the surface was computed keeps
// the age that it took over, with a positive sign.
#include "shared/buffers.glsl"
#include "shared/params.h"

WRITE_F(0, exposed)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n && AT(exposed, i) < 0.0)
        AT(exposed, i) = -AT(exposed, i);
}
