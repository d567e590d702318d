#version 460
#extension GL_GOOGLE_include_directive : require
// Erodibility of every particle under its stress (Arenite eq. 2).
#include "shared/buffers.glsl"
#include "shared/params.h"
#include "erosion/rate.glsl"

READ_V(0, layers)
READ_U(1, layer)
READ_F(2, rate_factor)
READ_F(3, interlock_factor)
READ_F(4, stress)
WRITE_F(5, erodibility)
PARAMS(interlock_params)

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(erodibility, i) = retreat(LOAD_V(layers, LOAD_U(layer, i)), LOAD_F(rate_factor, i),
                                     LOAD_F(interlock_factor, i), LOAD_F(stress, i), k.band);
}
