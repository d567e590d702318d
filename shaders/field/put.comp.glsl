#version 460
#extension GL_GOOGLE_include_directive : require
// Bricks back onto the lattice, from `first` of the list on: what field/take took.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_F(1, from)
WRITE_F(2, to)
PARAMS(field_brick_params)
#include "field/brick.glsl"
#include "field/lattice.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 c = brick_sample(LOAD_U(list, k.first + i / BRICK_SAMPLES), i % BRICK_SAMPLES);
    if (!brick_beyond(c))
        AT(to, lattice_index(c)) = LOAD_F(from, i);
}
