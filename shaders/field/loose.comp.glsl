#version 460
#extension GL_GOOGLE_include_directive : require
// Per sample: how much of its voxel is filled: 1 if there are only deposits in it, or as a negative number by
// rock. Deposits fill their voxel until water has removed them: their viability is what is left of their life,
// not their volume.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, words)
READ_U(2, start)
READ_F(3, fill)
READ_U(4, phase)
WRITE_F(5, loose)
PARAMS(field_params)
#include "field/lattice.glsl"
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"

float filled(ivec3 v)
{
    if (!voxel_inside(v))
        return 0.0;
    uint s = voxel_slot(v);
    if (s == NOT_HELD)
        return voxel_deep(v) ? -1.0 : 0.0;
    uint first = LOAD_U(start, s), end = LOAD_U(start, s + 1u);
    bool deposits = first < end; // a held voxel may have none
    for (uint j = first; j < end; j++)
        deposits = deposits && LOAD_U(phase, j) == PHASE_DEPOSIT;
    return deposits ? 1.0 : -LOAD_F(fill, s);
}

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(loose, i) = filled(brick_sample(LOAD_U(list, i / BRICK_SAMPLES), i % BRICK_SAMPLES) - int(k.margin));
}
