#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: marks the runs to keep for the particle's cell (mark.glsl).
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
    // Particles are ordered by voxel, so the previous particle has usually marked the same runs.
    if (i == 0u || runs_of(i - 1u) != runs)
        mark_runs(runs, CELLS);
}
