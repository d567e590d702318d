#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: the number of its part. The first particle of each part writes the part's first particle, cell
// and body.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, home)
READ_U(1, group)
READ_U(2, flags)
READ_U(3, place)
WRITE_U(4, part)
WRITE_U(5, part_first)
WRITE_U(6, part_cell)
WRITE_U(7, part_body)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint begins = LOAD_U(flags, i), p = LOAD_U(place, i) + begins - 1u;
    AT(part, i) = p;
    if (i + 1u == k.n)
        AT(part_first, p + 1u) = k.n;
    if (begins == 0u)
        return;
    AT(part_first, p) = i;
    AT(part_cell, p) = LOAD_U(home, i);
    AT(part_body, p) = LOAD_U(group, i);
}
