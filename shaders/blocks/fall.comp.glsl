#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: sets the viability of unsupported ones to 0 and counts them.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
READ_U(1, solid)
READ_U(2, root)
READ_U(3, start)
READ_U(4, phase)
WRITE_F(5, viability)
WRITE_U(6, counts)
READ_U(7, words)
PARAMS(voxel_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"
#include "blocks/stands.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n || held(voxel_of(LOAD_V(position, i).xyz), LOAD_U(phase, i)))
        return;
    AT(viability, i) = 0.0;
    atomicAdd(AT(counts, COUNT_FALLEN), 1u);
}
