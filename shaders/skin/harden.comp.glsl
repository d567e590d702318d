#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle: stores the age that skin/reach found, and multiplies its erodibility by the factor of
// crust and damp.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_V(2, normal)
READ_U(3, phase)
READ_F(4, viability)
READ_U(5, words)
READ_F(6, fill)
READ_F(7, found) // by place in the list
WRITE_F(8, exposed)
WRITE_F(9, crust)
WRITE_F(10, damp)
WRITE_F(11, erodibility)
PARAMS(skin_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/fill.glsl"
#include "skin/damp.glsl"
#include "skin/crust.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    float age = LOAD_F(found, i), rate = 1.0, wet = 0.0;
    AT(exposed, self) = age;
    if (LOAD_U(phase, self) != PHASE_DEPOSIT && (k.crust > 1.0 || k.damp > 1.0)) {
        wet = damp_at(LOAD_V(position, self).xyz + (LOAD_F(viability, self) - 0.5) * k.h * LOAD_V(normal, self).xyz);
        rate = crust_rate(age, wet);
        AT(erodibility, self) *= rate;
    }
    AT(crust, self) = rate;
    AT(damp, self) = wet;
}
