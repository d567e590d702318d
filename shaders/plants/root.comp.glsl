#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: clears the cover of particles inside, which have no normal.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, normal)
WRITE_F(1, vegetation)
PARAMS(plants_params)

void main()
{
    uint i = THREAD;
    if (i < k.n && LOAD_V(normal, i).xyz == vec3(0.0))
        AT(vegetation, i) = 0.0;
}
