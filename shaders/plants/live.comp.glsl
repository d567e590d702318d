#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle with plants: logistic growth of cover on deposits, none on rock, and exponential decay
// where plants cannot stand (stand.glsl).
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
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
    uint self = LOAD_U(list, i);
    float cover = AT(vegetation, self);
    if (cover <= 0.0)
        return;
    if (!stands(LOAD_V(position, self).xyz))
        cover *= k.death;
    else if (LOAD_U(phase, self) == 1u)
        cover *= k.growth / (1.0 + cover * (k.growth - 1.0));
    AT(vegetation, self) = cover < GONE ? 0.0 : min(cover, 1.0);
}
