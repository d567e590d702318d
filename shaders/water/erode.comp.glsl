#version 460
#extension GL_GOOGLE_include_directive : require
// What running water adds to the intensity on each particle of the surface (Arenite eq. 14): shear above the
// threshold.
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
WRITE_F(9, intensity)
PARAMS(water_surface_params)
#include "water/columns.glsl"
#include "water/discharge.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    vec3 n = LOAD_V(normal, self).xyz;
    if (n.z <= 0.0)
        return;
    float q = discharge_at(LOAD_V(position, self).xyz);
    float slope = min(length(n.xy) / n.z, k.steepest);
    if (q <= 0.0 || slope <= 0.0)
        return;
    float shear = k.shear * pow(q, 0.6) * pow(slope, 0.7);
    AT(intensity, i) += k.rate * max(0.0, shear - k.threshold);
}
