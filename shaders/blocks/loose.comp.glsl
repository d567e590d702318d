#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: 1 if it has viability left and is unsupported.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
READ_U(1, solid)
READ_U(2, root)
READ_U(3, start)
READ_U(4, phase)
READ_F(5, viability)
WRITE_U(6, flags)
READ_U(7, words)
PARAMS(crumble_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"
#include "blocks/stands.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    bool stays = LOAD_F(viability, i) <= 0.0 || held(voxel_of(LOAD_V(position, i).xyz), LOAD_U(phase, i));
    AT(flags, i) = stays ? 0u : 1u;
}
