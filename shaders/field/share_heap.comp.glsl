#version 460
#extension GL_GOOGLE_include_directive : require
// Per sample: share of rock as in field/share, from what fills the samples' voxels. A heap's surface continues
// level into rock beside it, so that it neither stirs as that weathers nor climbs it: a neighbour of rock
// counts as filled to the height of the heap's own column.
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

float filled_at(ivec3 v)
{
    v = side_voxel(v);
    if (!voxel_inside(v))
        return 0.0;
    ivec3 c = v + int(k.margin);
    uint s = LOAD_U(slot, brick_of(c));
    return slot_kept(s) ? LOAD_F(filled, slot_sample(s, c)) : -slot_share(s);
}

ivec3 own;
vec3 column; // of the voxel, from the one below it upward, if it is on a heap; rock counts as full
bool on_heap;

float fill_at(ivec3 v)
{
    float here = filled_at(v);
    return here >= 0.0 ? here : on_heap ? column[v.z - own.z + 1] : -here;
}
#include "particles/share.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 c = brick_sample(LOAD_U(list, i / BRICK_SAMPLES), i % BRICK_SAMPLES);
    own = c - int(k.margin);
    column = vec3(filled_at(own - ivec3(0, 0, 1)), filled_at(own), filled_at(own + ivec3(0, 0, 1)));
    on_heap = column.y > 0.0 || (column.y == 0.0 && column.x > 0.0);
    column = mix(column, vec3(1.0), lessThan(column, vec3(0.0)));
    AT(share, i) = lattice_beyond(c) ? 0.0 : share_at(own);
}
