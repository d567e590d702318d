#version 460
#extension GL_GOOGLE_include_directive : require
// What running water adds to the intensity on each particle of the surface (Arenite eq. 14): shear above the
// threshold, held to what a step can take.
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
READ_F(9, erodibility)
WRITE_F(10, intensity)
WRITE_U(11, parts) // deflation's and water's share in it
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
    float rate = LOAD_F(erodibility, self), q = discharge_at(LOAD_V(position, self).xyz);
    float slope = min(length(n.xy) / n.z, k.steepest);
    if (rate <= 0.0 || q <= 0.0 || slope <= 0.0)
        return;
    float shear = k.shear * pow(q, 0.6) * pow(slope, 0.7);
    float cut = min(k.rate * max(0.0, shear - k.threshold), k.most / rate), sum = AT(intensity, i) + cut;
    AT(intensity, i) = sum;
    if (cut > 0.0)
        AT(parts, i) = packUnorm2x16(vec2(unpackUnorm2x16(AT(parts, i)).x * (1.0 - cut / sum), cut / sum));
}
