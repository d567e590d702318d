#version 460
#extension GL_GOOGLE_include_directive : require
// Particles of which nothing is left are crumbs.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, viability)
WRITE_U(1, crumb)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(crumb, i) = LOAD_F(viability, i) <= 0.0 ? 1u : 0u;
}
