#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle: exposure age after a step. On rock the exact solution of A' = 1 - R A / d for constant
// retreat R, which includes the crust as it is half-way through the step. Deposits age by the step's length,
// whatever water removes from them.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, phase)
READ_F(2, erodibility)
READ_F(3, damp)
WRITE_F(4, intensity) // by place in the list
WRITE_F(5, exposed)
PARAMS(skin_params)
#include "skin/crust.glsl"

float aged(float age, float retreat, float kyr)
{
    float worn = retreat * kyr / k.depth, left = exp(-worn);
    return age * left + kyr * (worn > 1e-3 ? (1.0 - left) / worn : 1.0 - 0.5 * worn);
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    float age = AT(exposed, self), wet = LOAD_F(damp, self);
    if (LOAD_U(phase, self) == PHASE_DEPOSIT) {
        AT(exposed, self) = age + k.kyr;
        return;
    }
    if (k.crust > 1.0) {
        float fresh = LOAD_F(erodibility, self) * AT(intensity, i) / crust_rate(age, wet), rate = crust_rate(age, wet);
        for (int guess = 0; guess < 3; guess++)
            rate = crust_rate(aged(age, fresh * rate, 0.5 * k.kyr), wet);
        AT(intensity, i) *= rate / crust_rate(age, wet);
    }
    AT(exposed, self) = aged(age, LOAD_F(erodibility, self) * AT(intensity, i), k.kyr);
}
