#version 460
#extension GL_GOOGLE_include_directive : require
// Nodes that move: those of cells with rock, but for the ground's, which are held.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, fill)
WRITE_U(1, active_node)
PARAMS(stress_params)
#include "stress/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 a = node_of(i);
    bool moves = false;
    if (a.x >= 1 && a.y >= 1 && a.z >= 2 && a.x < int(k.cx) && a.y < int(k.cy) && a.z < int(k.cz))
        for (int e = 0; e < 8; e++)
            moves = moves || LOAD_F(fill, cell_index(a - ivec3(e & 1, (e >> 1) & 1, e >> 2))) > 0.0;
    AT(active_node, i) = moves ? 1u : 0u;
}
