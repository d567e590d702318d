#version 460
#extension GL_GOOGLE_include_directive : require
// Per part: the first of each cell writes the cell's first part plus 1 and their number. Other cells keep 0.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, part_cell)
WRITE_U(1, slot)
WRITE_U(2, many)
PARAMS(count_params)

void main()
{
    uint p = THREAD;
    if (p >= k.n)
        return;
    uint cell = LOAD_U(part_cell, p), end = p + 1u;
    if (p > 0u && LOAD_U(part_cell, p - 1u) == cell)
        return;
    while (end < k.n && LOAD_U(part_cell, end) == cell)
        end++;
    AT(slot, cell) = p + 1u;
    AT(many, cell) = end - p;
}
