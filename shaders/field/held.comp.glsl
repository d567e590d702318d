#version 460
#extension GL_GOOGLE_include_directive : require
// Which bricks hold anything: rock, or samples within the band around its surface.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, distance_field)
READ_F(1, share)
WRITE_U(2, held)
PARAMS(field_brick_params)
#include "field/brick.glsl"
#include "field/lattice.glsl"

void main()
{
    uint brick = THREAD;
    if (brick >= k.n)
        return;
    bool any_held = false;
    for (uint s = 0u; s < BRICK_SAMPLES && !any_held; s++) {
        ivec3 c = brick_sample(brick, s);
        if (!brick_beyond(c)) {
            uint i = lattice_index(c);
            any_held = LOAD_F(distance_field, i) < k.background || LOAD_F(share, i) > 0.0;
        }
    }
    AT(held, brick) = any_held ? 1u : 0u;
}
