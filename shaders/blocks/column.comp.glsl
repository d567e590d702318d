#version 460
#extension GL_GOOGLE_include_directive : require
// Every voxel that holds rock first points to the one below if that does too, else to itself; empty ones to themselves.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, start)
WRITE_U(1, pointer)
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
    uint below = k.nx * k.ny;
    AT(pointer, v) = v >= below && rock(v) && rock(v - below) ? v - below : v;
}
