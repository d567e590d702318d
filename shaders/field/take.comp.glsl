#version 460
#extension GL_GOOGLE_include_directive : require
// A rock's share that is known at every sample of the lattice, brought into bricks.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_F(1, known)
WRITE_F(2, share)
PARAMS(field_params)
#include "field/lattice.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 c = brick_sample(LOAD_U(list, i / BRICK_SAMPLES), i % BRICK_SAMPLES);
    AT(share, i) = lattice_beyond(c) ? 0.0 : LOAD_F(known, (uint(c.z) * k.fy + uint(c.y)) * k.fx + uint(c.x));
}
