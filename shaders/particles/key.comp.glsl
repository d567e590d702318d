#version 460
#extension GL_GOOGLE_include_directive : require
// A particle's sort key: its voxel, or the number of voxels once nothing is left of it.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
READ_F(1, viability)
WRITE_U(2, key)
PARAMS(voxel_params)
#include "particles/voxel.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    bool dead = LOAD_F(viability, i) <= 0.0;
    AT(key, i) = dead ? k.nx * k.ny * k.nz : voxel_index(voxel_of(LOAD_V(position, i).xyz));
}
