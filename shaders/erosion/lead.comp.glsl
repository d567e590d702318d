#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle of rock in thin beds: intensity *= max(f sin(angle between normal and the beds' normal),
// 1), where f (`along`) is how many times faster a front runs along the beds than across them. Across beds time
// adds up, along them the softest lead (law: src/geology/README.md).
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_V(2, normal)
READ_U(3, phase)
READ_U(4, along)
WRITE_F(5, intensity)
PARAMS(lead_params)
#include "particles/voxel.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    if (LOAD_U(phase, self) != PHASE_ROCK)
        return;
    uint v = voxel_index(voxel_of(LOAD_V(position, self).xyz));
    float faster = exp2(float(LOAD_U(along, v >> 2) >> (8u * (v & 3u)) & 255u) / float(MAPS_OCTAVE));
    float across = dot(LOAD_V(normal, self).xyz, vec3(k.bed_x, k.bed_y, k.bed_z));
    AT(intensity, i) *= max(faster * sqrt(max(1.0 - across * across, 0.0)), 1.0);
}
