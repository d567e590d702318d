#version 460
#extension GL_GOOGLE_include_directive : require
// One sweep of the distance outwards from the surface: |grad phi| = 1, upwind (Rouy and Tourin 1992). Samples
// beside the surface keep what field/front gave them.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, before)
WRITE_F(1, after)
PARAMS(field_params)
#include "field/lattice.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 c = lattice_of(i), last = ivec3(k.fx, k.fy, k.fz) - 1;
    float own = LOAD_F(before, i), sign_own = own > 0.0 ? 1.0 : -1.0, far = 3.0 * k.h;
    vec3 near;
    bool beside = false;
    for (int axis = 0; axis < 3; axis++) {
        ivec3 d = ivec3(axis == 0, axis == 1, axis == 2);
        float lower = sign_own * LOAD_F(before, lattice_index(max(c - d, ivec3(0))));
        float upper = sign_own * LOAD_F(before, lattice_index(min(c + d, last)));
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
