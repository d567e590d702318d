#version 460
#extension GL_GOOGLE_include_directive : require
// Per sample: finds the heads of columns, their heights from the particles, and the depth of their deposits.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, slot)
READ_F(2, loose)
WRITE_F(3, height)
WRITE_V(4, base)
PARAMS(field_params)
#include "field/lattice.glsl"
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/sides.glsl"
#include "field/heap.glsl"

// How much of a voxel is filled, negative: by rock. Below z = 0 is rock.
float filled(ivec3 v)
{
    uint s = voxel_sample(v);
    return v.z < 0 ? -1.0 : s == SAMPLE_NONE ? 0.0 : LOAD_F(loose, s);
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 v = brick_sample(LOAD_U(list, i / BRICK_SAMPLES), i % BRICK_SAMPLES) - int(k.margin), down = ivec3(0, 0, 1);
    float own = LOAD_F(loose, i), below = filled(v - down), top = HEAP_NONE, bottom = 0.0;
    if (!voxel_inside(v) || own < 0.0) {
        ;
    } else if (own > 0.0) {
        if (filled(v + down) == 0.0) {
            top = HEAP_UNIT * (float(v.z) + own);
            bottom = HEAP_UNIT * float(v.z);
            for (int d = 1; d <= HEAP_REACH && filled(v - d * down) > 0.0; d++)
                bottom = HEAP_UNIT * float(v.z - d);
        }
    } else if (below < 0.0) {
        top = bottom = HEAP_UNIT * float(v.z);
    }
    AT(height, i) = top;
    AT(base, i) = vec4(bottom, 0.0, 0.0, 0.0);
}
