#version 460
#extension GL_GOOGLE_include_directive : require
// Which entries of a node, each a piece's, joints that hold keep together there: each one's first in its group.
// Pieces that hold together only elsewhere may open here.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, nodes)
READ_U(2, first)
READ_U(3, meeting)
READ_U(4, entry_body)
READ_U(5, holds)
WRITE_U(6, group)
PARAMS(mpm_load_params)

// Grains are with no piece. Numbers as in mpm/load.
bool together(uint a, uint b)
{
    if (a == MPM_LOOSE || b == MPM_LOOSE)
        return false;
    uint low = min(a, b) - 1u, high = max(a, b) - 1u, slab = k.nx * k.ny;
    ivec3 way = ivec3(high % k.nx, high / k.nx % k.ny, high / slab) - ivec3(low % k.nx, low / k.nx % k.ny, low / slab);
    int number = (way.z * 5 + way.y) * 5 + way.x - 1;
    bool near = all(lessThanEqual(abs(way), ivec3(2)));
    return near && LOAD_U(holds, low * MPM_JOINTS + uint(number)) != 0u;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(nodes, LOAD_U(list, i)), e0 = LOAD_U(first, node), end = e0 + LOAD_U(meeting, node);
    for (uint e = e0; e < end; e++)
        AT(group, e) = e;
    for (uint a = e0; a < end; a++)
        for (uint b = a + 1u; b < end; b++) {
            uint one = AT(group, a), other = AT(group, b);
            if (one == other || !together(LOAD_U(entry_body, a), LOAD_U(entry_body, b)))
                continue;
            for (uint e = e0; e < end; e++)
                if (AT(group, e) == max(one, other))
                    AT(group, e) = min(one, other);
        }
}
