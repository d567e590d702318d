#version 460
#extension GL_GOOGLE_include_directive : require
// Marks the runs to be kept for the cells with particles.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
WRITE_U(1, mark)
PARAMS(voxel_params)
#include "particles/voxel.glsl"
#include "stress/grid.glsl"
#include "stress/mark.glsl"

#define CELLS (uvec3(k.nx, k.ny, k.nz) / 2u + 2u)

uvec2 runs_of(uint i)
{
    return runs_with(voxel_of(LOAD_V(position, i).xyz) / 2 + 1, CELLS);
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uvec2 runs = runs_of(i);
    // Particles are ordered by voxel: mostly the one before has marked them.
    if (i == 0u || runs_of(i - 1u) != runs)
        mark_runs(runs, CELLS);
}
