#version 460
#extension GL_GOOGLE_include_directive : require
// Which entry each part gives to and takes from at each of its 27 nodes; and, after those, its cell. Of more bodies
// than a node tells apart the others go with its last.
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
