#version 460
#extension GL_GOOGLE_include_directive : require
// One round of joining face neighbours: a voxel takes the lowest pointer around, and that one's pointer. Pointers only fall
// and never leave their block, so that all of a block end at its lowest voxel; voxels are numbered upwards, so that is one
// on the ground if the block has any.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, start)
READ_U(1, before)
WRITE_U(2, pointer)
WRITE_U(3, counts)
PARAMS(voxel_params)

bool rock(uint v)
{
    return LOAD_U(start, v) != LOAD_U(start, v + 1u);
}

void main()
{
    uint v = THREAD;
    if (v >= k.n)
        return;
    uint own = LOAD_U(before, v), least = own;
    if (rock(v)) {
        uint row = k.nx, layer = k.nx * k.ny, x = v % row, y = (v / row) % k.ny;
        if (x > 0u && rock(v - 1u))
            least = min(least, LOAD_U(before, v - 1u));
        if (x + 1u < k.nx && rock(v + 1u))
            least = min(least, LOAD_U(before, v + 1u));
        if (y > 0u && rock(v - row))
            least = min(least, LOAD_U(before, v - row));
        if (y + 1u < k.ny && rock(v + row))
            least = min(least, LOAD_U(before, v + row));
        if (v >= layer && rock(v - layer))
            least = min(least, LOAD_U(before, v - layer));
        if (v + layer < k.n && rock(v + layer))
            least = min(least, LOAD_U(before, v + layer));
        least = min(least, LOAD_U(before, least));
    }
    AT(pointer, v) = least;
    if (least != own)
        AT(counts, COUNT_CHANGED) = 1u;
}
