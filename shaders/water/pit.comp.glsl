#version 460
#extension GL_GOOGLE_include_directive : require
// Per span: 1 if it is a pit, its own root.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, root)
WRITE_U(1, pit)
PARAMS(water_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(pit, i) = LOAD_U(root, i) == i ? 1u : 0u;
}
