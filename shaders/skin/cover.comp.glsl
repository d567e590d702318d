#version 460
#extension GL_GOOGLE_include_directive : require
// What was bared and is covered again before the surface was found, by a deposit that came to rest there, keeps what it took over.
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
