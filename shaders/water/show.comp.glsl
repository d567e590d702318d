#version 460
#extension GL_GOOGLE_include_directive : require
// The discharge of each particle of the surface; on ceilings, as inside, it stays 0.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_V(2, normal)
READ_U(3, occupied)
READ_U(4, floors)
READ_U(5, first)
READ_U(6, altitude)
READ_U(7, rain)
READ_U(8, spring)
WRITE_F(9, discharge)
PARAMS(water_surface_params)
#include "water/columns.glsl"
#include "water/discharge.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    if (LOAD_V(normal, self).z > 0.0)
        AT(discharge, self) = discharge_at(LOAD_V(position, self).xyz);
}
