#version 460
#extension GL_GOOGLE_include_directive : require
// Per sample: share of rock around it (particles/share.glsl). Samples are the voxels' centres and a margin of
// air around the domain.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, words)
READ_F(2, fill)
WRITE_F(3, share)
PARAMS(field_params)
#include "field/lattice.glsl"
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/fill.glsl"
#include "particles/share.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 c = brick_sample(LOAD_U(list, i / BRICK_SAMPLES), i % BRICK_SAMPLES);
    AT(share, i) = lattice_beyond(c) ? 0.0 : share_at(c - int(k.margin));
}
