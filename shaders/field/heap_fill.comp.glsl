#version 460
#extension GL_GOOGLE_include_directive : require
// How much of each sample's voxel is filled, by rock as it was, and by deposits up to the heights of their columns.
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

// The rock that fills a voxel; below the ground all is.
float rock_in(ivec3 v)
{
    uint s = voxel_sample(v);
    return v.z < 0 ? 1.0 : s == SAMPLE_NONE ? 0.0 : max(-LOAD_F(loose, s), 0.0);
}

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
        float top = LOAD_F(height, s);
        if (LOAD_F(loose, s) == 0.0) // over bare rock, which fills some of the voxel below the head
            top += 1.0 - rock_in(head - ivec3(0, 0, 1));
        float here = clamp(top - float(v.z), 0.0, 1.0);
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
    AT(filled, i) = !voxel_inside(v) ? 0.0 : own < 0.0 ? -own : deposits_in(v, own);
}
