#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of a column: the lowest cell of each of its spans.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, floors)
READ_U(1, first)
WRITE_U(2, cell)
PARAMS(water_params)

void main()
{
    uint word = THREAD;
    if (word >= k.n)
        return;
    uint column = word / k.words, level = (word % k.words) * 32u;
    uint node = LOAD_U(first, word), bits = LOAD_U(floors, word);
    while (bits != 0u) {
        uint bit = uint(findLSB(bits));
        AT(cell, node) = (level + bit) * k.cx * k.cy + column;
        node++;
        bits &= bits - 1u;
    }
}
