#version 460
#extension GL_GOOGLE_include_directive : require
// Which base cells hold particles.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, start)
WRITE_U(1, flags)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(flags, i) = LOAD_U(start, i + 1u) > LOAD_U(start, i) ? 1u : 0u;
}
