#version 460
#extension GL_GOOGLE_include_directive : require
// The surface has the ages that were found for it (skin/reach).
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_F(1, found) // by place in the list
WRITE_F(2, exposed)
PARAMS(skin_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(exposed, LOAD_U(list, i)) = LOAD_F(found, i);
}
