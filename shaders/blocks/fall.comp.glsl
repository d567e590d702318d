#version 460
#extension GL_GOOGLE_include_directive : require
// Particles whose block nowhere stands on the ground are taken out.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
READ_U(1, pointer)
WRITE_F(2, viability)
WRITE_U(3, counts)
PARAMS(voxel_params)
#include "particles/voxel.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n || LOAD_U(pointer, voxel_index(voxel_of(LOAD_V(position, i).xyz))) < k.nx * k.ny)
        return;
    AT(viability, i) = 0.0;
    atomicAdd(AT(counts, COUNT_FALLEN), 1u);
}
