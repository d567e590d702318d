#version 460
#extension GL_GOOGLE_include_directive : require
// Per sample: signed distance of samples beside the surface (share = 1/2), to the plane through the points at
// which the axes cross it, by linear interpolation, or by extrapolation if it lies beyond the next sample. All
// others are set to 3 voxels, for field/distance to refine.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, slot)
READ_F(2, share)
WRITE_F(3, distance_out)
PARAMS(field_params)
#include "field/lattice.glsl"

float share_of(ivec3 c)
{
    uint s = LOAD_U(slot, brick_of(c));
    return slot_kept(s) ? LOAD_F(share, slot_sample(s, c)) : slot_share(s);
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 c = brick_sample(LOAD_U(list, i / BRICK_SAMPLES), i % BRICK_SAMPLES), last = ivec3(k.fx, k.fy, k.fz) - 1;
    if (lattice_beyond(c)) {
        AT(distance_out, i) = 3.0 * k.h;
        return;
    }
    float own = 0.5 - LOAD_F(share, i), inverse = 0.0;
    bool beside = false;
    for (int axis = 0; axis < 3; axis++) {
        float steepest = 0.0; // largest change of the share per voxel along this axis, over own
        for (int side = -1; side <= 1; side += 2) {
            ivec3 d = ivec3(axis == 0, axis == 1, axis == 2) * side;
            float other = 0.5 - share_of(clamp(c + d, ivec3(0), last));
            beside = beside || (own > 0.0) != (other > 0.0);
            steepest = max(steepest, own != 0.0 ? (own - other) / own : 1e3);
        }
        inverse += steepest * steepest;
    }
    float away = beside ? inversesqrt(inverse) : 3.0;
    AT(distance_out, i) = (own > 0.0 ? away : -away) * k.h;
}
