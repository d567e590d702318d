#version 460
#extension GL_GOOGLE_include_directive : require
// Per cell of the box: 1 if it holds surface of the rock.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, sums)
WRITE_U(1, flags)
PARAMS(flow_params)

void main()
{
    uint c = THREAD;
    if (c < k.n)
        AT(flags, c) = LOAD_U(sums, 8u * c) != 0u ? 1u : 0u;
}
