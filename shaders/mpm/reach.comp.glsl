#version 460
#extension GL_GOOGLE_include_directive : require
// Per part and each of its 27 nodes: the entry to which the part gives and from which it takes; and for index
// 27 its cell. Bodies beyond the MPM_BODIES that a node distinguishes share the last entry.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, part_cell)
READ_U(1, part_body)
READ_U(2, first)
READ_U(3, meeting)
READ_U(4, entry_body)
WRITE_U(5, reach)
PARAMS(mpm_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint a = i / k.n_parts, p = i % k.n_parts, cell = LOAD_U(part_cell, p), e = cell;
    if (a < 27u) {
        uint row = k.cx + 3u, node = cell + ((a / 9u) * (k.cy + 3u) + a / 3u % 3u) * row + a % 3u;
        e = LOAD_U(first, node);
        uint body = LOAD_U(part_body, p), last = e + LOAD_U(meeting, node) - 1u;
        while (e < last && LOAD_U(entry_body, e) != body)
            e++;
    }
    AT(reach, i) = e;
}
