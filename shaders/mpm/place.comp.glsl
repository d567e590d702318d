#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle of the rock: enters its number into the table by id.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, ids)
WRITE_U(1, place)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(place, LOAD_U(ids, i)) = i;
}
