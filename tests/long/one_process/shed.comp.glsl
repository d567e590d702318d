#version 460
#extension GL_GOOGLE_include_directive : require
// What comes off bare rock in a step: a share of what is left of it. A sliver stays, for erosion to count out.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, phase)
READ_F(2, erodibility)
WRITE_F(3, viability)
WRITE_F(4, shed) // by place in the list
PARAMS(erosion_params) // dt: in the time in which all but 1/e comes off

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    float before = AT(viability, self), after = max(before * exp(-k.dt), 1e-4);
    bool sheds = LOAD_U(phase, self) == PHASE_ROCK && LOAD_F(erodibility, self) > 0.0 && before > after;
    AT(shed, i) = sheds ? before - after : 0.0;
    if (sheds)
        AT(viability, self) = after;
}
