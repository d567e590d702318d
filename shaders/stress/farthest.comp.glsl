#version 460
#extension GL_GOOGLE_include_directive : require
// Per kept cell: maximum over the filled cells of their largest coordinate, counted in cells from the domain's
// low corner. The host uses it to choose the number of levels.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, run)
READ_F(1, fill)
WRITE_U(2, words)
PARAMS(stress_params)
#include "stress/grid.glsl"

void main()
{
    uint i = THREAD;
    // Within a row of filled cells only the last can be the farthest.
    if (i >= k.n || LOAD_F(fill, i) == 0.0 || LOAD_F(fill, i + 1u) != 0.0)
        return;
    ivec3 c = node_of(LOAD_U(run, i / STRESS_RUN), i, uvec3(k.cx, k.cy, k.cz));
    atomicMax(AT(words, 0), uint(max(c.x, max(c.y, c.z))));
}
