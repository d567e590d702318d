#version 460
#extension GL_GOOGLE_include_directive : require
// Per kept cell of the finer level: if it is filled, marks the runs of the coarse level to keep for its parent.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, run)
READ_F(1, fill)
WRITE_U(2, mark)
PARAMS(coarse_params)
#include "stress/grid.glsl"
#include "stress/mark.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n || LOAD_F(fill, i) == 0.0)
        return;
    ivec3 child = node_of(LOAD_U(run, i / STRESS_RUN), i, uvec3(k.cx, k.cy, k.cz));
    uvec3 above = uvec3(k.px, k.py, k.pz);
    uvec2 runs = runs_with((child + 1) / 2, above);
    // The previous child has usually marked the same runs.
    if (LOAD_F(fill, i - 1u) == 0.0 || runs_with((child + ivec3(0, 1, 1)) / 2, above) != runs)
        mark_runs(runs, above);
}
