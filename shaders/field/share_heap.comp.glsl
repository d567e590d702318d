#version 460
#extension GL_GOOGLE_include_directive : require
// The rock's share of space at each sample, as field/share has it, from what fills the samples' voxels.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, slot)
READ_F(2, filled)
WRITE_F(3, share)
PARAMS(field_params)
#include "field/lattice.glsl"
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/sides.glsl"

float fill_at(ivec3 v)
{
    v = side_voxel(v);
    if (!voxel_inside(v))
        return 0.0;
    ivec3 c = v + int(k.margin);
    uint s = LOAD_U(slot, brick_of(c));
    return slot_kept(s) ? LOAD_F(filled, slot_sample(s, c)) : slot_share(s);
}
#include "particles/share.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 c = brick_sample(LOAD_U(list, i / BRICK_SAMPLES), i % BRICK_SAMPLES);
    AT(share, i) = lattice_beyond(c) ? 0.0 : share_at(c - int(k.margin));
}
