#version 460
#extension GL_GOOGLE_include_directive : require
// Per kept node: flags it (1) if its displacement is an unknown, that is if any of its eight cells has fill and
// it does not lie on the ground (z = 0), where u = 0.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, run)
READ_U(1, table)
READ_F(2, fill)
WRITE_U(3, active_node)
PARAMS(stress_params)
#include "stress/grid.glsl"
#include "stress/rows.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint own = LOAD_U(run, i / STRESS_RUN);
    ivec3 a = node_of(own, i, CELLS);
    bool moves = false;
    if (own != STRESS_NO_RUN && a.x >= 1 && a.y >= 1 && a.z >= 2 && a.x < int(k.cx) && a.y < int(k.cy) &&
        a.z < int(k.cz))
        for (int b = 0; b < 4; b++) {
            uint row = row_at(own, i, -(b & 1), -(b >> 1));
            moves = moves || LOAD_F(fill, row) != 0.0 || LOAD_F(fill, row - 1u) != 0.0;
        }
    AT(active_node, i) = moves ? 1u : 0u;
}
