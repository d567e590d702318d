#version 460
#extension GL_GOOGLE_include_directive : require
// Voxels that get their particles are not deep any more.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, born)
WRITE_U(1, deep)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(deep, i) &= ~LOAD_U(born, i);
}
