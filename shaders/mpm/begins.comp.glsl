#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: 1 if it is the first of a part, the particles of one group in one cell.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, home)
READ_U(1, group)
WRITE_U(2, flags)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    bool begins = i == 0u || LOAD_U(home, i) != LOAD_U(home, i - 1u) || LOAD_U(group, i) != LOAD_U(group, i - 1u);
    AT(flags, i) = begins ? 1u : 0u;
}
