#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: erodibility E(T), m/kyr (Arenite eq. 2), from its layer's rates, its own factors and its
// stress. Deposits have no cement and never interlock: they have the weak rate.
#include "shared/buffers.glsl"
#include "shared/params.h"
#include "erosion/rate.glsl"

READ_V(0, layers)
READ_U(1, layer)
READ_F(2, rate_factor)
READ_F(3, interlock_factor)
READ_F(4, stress)
READ_U(5, phase)
WRITE_F(6, erodibility)
PARAMS(interlock_params)
#include "erosion/layer.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    vec4 rates = layer_rates(LOAD_U(layer, i));
    float factor = LOAD_F(rate_factor, i);
    AT(erodibility, i) = LOAD_U(phase, i) == 1u
                             ? factor * rates.x
                             : retreat(rates, factor, LOAD_F(interlock_factor, i), LOAD_F(stress, i), k.band);
}
