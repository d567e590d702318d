#version 460
#extension GL_GOOGLE_include_directive : require
// Which particles nothing on the ground holds.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
READ_U(1, solid)
READ_U(2, root)
READ_U(3, start)
READ_U(4, phase)
WRITE_U(5, flags)
READ_U(6, words)
PARAMS(voxel_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"
#include "blocks/stands.glsl"

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(flags, i) = held(voxel_of(LOAD_V(position, i).xyz), LOAD_U(phase, i)) ? 0u : 1u;
}
