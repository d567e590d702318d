#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle of rock: seepage q, m/yr, the largest over the beds; and the erodibility of wet rock,
// which has lost strength and interlocks only under more stress, T strength > I.
#include "shared/buffers.glsl"
#include "shared/params.h"
#include "erosion/rate.glsl"

READ_U(0, list)
READ_V(1, position)
READ_U(2, phase)
READ_V(3, wet)
READ_V(4, layers)
READ_U(5, layer)
READ_F(6, rate_factor)
READ_F(7, interlock_factor)
READ_F(8, stress)
WRITE_F(9, seepage)
WRITE_F(10, erodibility)
PARAMS(seep_params)
#include "particles/voxel.glsl"
#include "erosion/layer.glsl"
#include "groundwater/wet.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    if (LOAD_U(phase, self) != PHASE_ROCK)
        return;
    ivec3 v = voxel_of(LOAD_V(position, self).xyz);
    float most = 0.0;
    for (uint bed = 0u; bed < k.beds; bed++) {
        vec4 w = wet_at(v, bed);
        if (wet_zone(v, w) > 0.0)
            most = max(most, w.z);
        if (wet_top(v, w))
            most = max(most, w.w);
    }
    AT(seepage, self) = most;
    if (most > 0.0 && k.strength < 1.0)
        AT(erodibility, self) = retreat(layer_rates(LOAD_U(layer, self)), LOAD_F(rate_factor, self),
                                        LOAD_F(interlock_factor, self), LOAD_F(stress, self) * k.strength, k.band);
}
