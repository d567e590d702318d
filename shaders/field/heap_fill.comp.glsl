#version 460
#extension GL_GOOGLE_include_directive : require
// Per sample: how much of its voxel is filled: by deposits up to their columns' heights, or as a negative
// number by rock.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, slot)
READ_F(2, loose)
READ_F(3, height)
WRITE_F(4, filled)
PARAMS(field_params)
#include "field/lattice.glsl"
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/sides.glsl"
#include "field/heap.glsl"

float deposits_in(ivec3 v, float own)
{
    for (int i = 0; i <= 2 * HEAP_REACH; i++) {
        int up = heap_look(i);
        ivec3 head = v + ivec3(0, 0, up);
        uint s = voxel_sample(head);
        if (s == SAMPLE_NONE || LOAD_F(height, s) == HEAP_NONE)
            continue;
        if (own == 0.0 && up > 0) // a hole below it
            continue;
        float here = clamp(LOAD_F(height, s) / HEAP_UNIT - float(v.z), 0.0, 1.0);
        return up > 0 ? min(own, here) : here;
    }
    return own;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 v = brick_sample(LOAD_U(list, i / BRICK_SAMPLES), i % BRICK_SAMPLES) - int(k.margin);
    float own = LOAD_F(loose, i);
    AT(filled, i) = !voxel_inside(v) ? 0.0 : own < 0.0 ? own : deposits_in(v, own);
}
