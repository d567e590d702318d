#version 460
#extension GL_GOOGLE_include_directive : require
// A step passes for the surface: A' = 1 - R A / depth, R being its retreat, exactly where R does not change. Water that takes
// deposits takes nothing of a face.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, phase)
READ_F(2, erodibility)
READ_F(3, intensity) // by place in the list
WRITE_F(4, exposed)
PARAMS(skin_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    float worn = LOAD_U(phase, self) == PHASE_DEPOSIT ? 0.0 : LOAD_F(erodibility, self) * LOAD_F(intensity, i) * k.kyr / k.depth;
    float left = exp(-worn);
    AT(exposed, self) = AT(exposed, self) * left + k.kyr * (worn > 1e-3 ? (1.0 - left) / worn : 1.0 - 0.5 * worn);
}
