#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle at the end of a fall: writes its phase, rubble or deposit, to the rock.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, origin)
READ_U(1, kind)
WRITE_U(2, phase)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(phase, LOAD_U(origin, i)) = LOAD_U(kind, i);
}
