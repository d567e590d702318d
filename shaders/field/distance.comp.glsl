#version 460
#extension GL_GOOGLE_include_directive : require
// Per sample, one sweep of the distance outwards from the surface: |grad phi| = 1, upwind (Rouy and Tourin
// 1992). Samples beside the surface keep their values from field/front.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, slot)
READ_F(2, before)
WRITE_F(3, after)
PARAMS(field_params)
#include "field/lattice.glsl"

float before_at(ivec3 c)
{
    uint s = LOAD_U(slot, brick_of(c));
    return slot_kept(s) ? LOAD_F(before, slot_sample(s, c)) : slot_distance(s, k.h);
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 c = brick_sample(LOAD_U(list, i / BRICK_SAMPLES), i % BRICK_SAMPLES), last = ivec3(k.fx, k.fy, k.fz) - 1;
    if (lattice_beyond(c)) {
        AT(after, i) = 3.0 * k.h;
        return;
    }
    float own = LOAD_F(before, i), sign_own = own > 0.0 ? 1.0 : -1.0, far = 3.0 * k.h;
    vec3 near;
    bool beside = false;
    for (int axis = 0; axis < 3; axis++) {
        ivec3 d = ivec3(axis == 0, axis == 1, axis == 2);
        float lower = sign_own * before_at(max(c - d, ivec3(0)));
        float upper = sign_own * before_at(min(c + d, last));
        beside = beside || lower <= 0.0 || upper <= 0.0;
        near[axis] = min(lower, upper);
    }
    if (!beside) {
        float a = min(near.x, min(near.y, near.z)), e = max(near.x, max(near.y, near.z));
        float b = near.x + near.y + near.z - a - e, h = k.h;
        float d = a + h;
        if (d > b) {
            d = 0.5 * (a + b + sqrt(max(2.0 * h * h - (a - b) * (a - b), 0.0)));
            if (d > e)
                d = (a + b + e + sqrt(max((a + b + e) * (a + b + e) - 3.0 * (a * a + b * b + e * e - h * h), 0.0))) / 3.0;
        }
        own = sign_own * min(d, far);
    }
    AT(after, i) = own;
}
