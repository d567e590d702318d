#version 460
#extension GL_GOOGLE_include_directive : require
// Cover thickens on deposits (logistic), stays as it is on rock, and dies where plants cannot stand: on steep
// ground, under rock, and inside it, where there are no normals.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
READ_V(1, normal)
READ_U(2, phase)
READ_U(3, words)
WRITE_F(4, vegetation)
PARAMS(plants_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/empty.glsl"
#include "plants/stand.glsl"

const float GONE = 1e-3;

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    float cover = AT(vegetation, i);
    if (cover <= 0.0)
        return;
    if (!stands(LOAD_V(position, i).xyz, LOAD_V(normal, i).xyz))
        cover *= k.death;
    else if (LOAD_U(phase, i) == 1u)
        cover *= k.growth / (1.0 + cover * (k.growth - 1.0));
    AT(vegetation, i) = cover < GONE ? 0.0 : min(cover, 1.0);
}
