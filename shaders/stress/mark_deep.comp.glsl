#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of voxel bits: marks the runs to keep for the cells of deep voxels, which have no particles.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
WRITE_U(1, mark)
PARAMS(voxel_params)
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "stress/grid.glsl"
#include "stress/mark.glsl"

#define CELLS (uvec3(k.nx, k.ny, k.nz) / 2u + 2u)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint bits = deep_word(i);
    ivec3 v = voxel_at(32u * i);
    uvec2 before = uvec2(0xffffffffu);
    for (; bits != 0u; bits &= bits - 1u) {
        uvec2 runs = runs_with(ivec3(v.x + findLSB(bits), v.yz) / 2 + 1, CELLS);
        if (runs != before)
            mark_runs(runs, CELLS);
        before = runs;
    }
}
