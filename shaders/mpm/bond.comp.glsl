#version 460
#extension GL_GOOGLE_include_directive : require
// Per mixed node: groups its entries, each a piece's, by the joints that hold between them; an entry's group is
// the first entry of it. Two pieces whose own joint has parted stay in different groups even if a third piece
// holds on to both; the third goes with one of them.
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

// State of the joint between two pieces: 0 none, 1 holds, 2 has parted them. Numbering as in mpm/load. Loose grains have no joints.
uint joint_between(uint a, uint b)
{
    if (a == MPM_LOOSE || b == MPM_LOOSE)
        return 0u;
    uint low = min(a, b) - 1u, high = max(a, b) - 1u, slab = k.nx * k.ny;
    ivec3 way = ivec3(high % k.nx, high / k.nx % k.ny, high / slab) - ivec3(low % k.nx, low / k.nx % k.ny, low / slab);
    int number = (way.z * 5 + way.y) * 5 + way.x - 1;
    bool near = all(lessThanEqual(abs(way), ivec3(2)));
    return near ? LOAD_U(holds, low * MPM_JOINTS + uint(number)) : 0u;
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
            bool join = one != other && joint_between(LOAD_U(entry_body, a), LOAD_U(entry_body, b)) == 1u;
            for (uint p = e0; p < end && join; p++)
                for (uint q = e0; q < end && join; q++)
                    if (AT(group, p) == one && AT(group, q) == other)
                        join = joint_between(LOAD_U(entry_body, p), LOAD_U(entry_body, q)) != 2u;
            if (!join)
                continue;
            for (uint e = e0; e < end; e++)
                if (AT(group, e) == max(one, other))
                    AT(group, e) = min(one, other);
        }
}
