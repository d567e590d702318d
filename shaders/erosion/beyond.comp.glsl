#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle that vanished in the last round: what the step would still have eroded of rock next to it, as
// viability, where the carry stops because rock that deep need not have particles. The host sums it for a
// warning.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
READ_F(1, unspent)
READ_F(2, viability)
READ_U(3, phase)
READ_U(4, start)
READ_U(5, words)
READ_F(6, erodibility)
WRITE_F(7, beyond)
PARAMS(voxel_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"

// Whether a voxel holds rock that can erode; deep voxels count as such.
bool rock_in(ivec3 v)
{
    if (!voxel_inside(v))
        return false;
    if (voxel_deep(v))
        return true;
    uvec2 in_voxel = voxel_particles(v);
    for (uint j = in_voxel.x; j < in_voxel.y; j++)
        if (LOAD_F(viability, j) > 0.0 && LOAD_F(erodibility, j) > 0.0 && LOAD_U(phase, j) != PHASE_DEPOSIT)
            return true;
    return false;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    float left = 0.0;
    if (LOAD_F(unspent, i) > 0.0) {
        ivec3 v = voxel_of(LOAD_V(position, i).xyz);
        if (rock_in(v + ivec3(1, 0, 0)) || rock_in(v - ivec3(1, 0, 0)) || rock_in(v + ivec3(0, 1, 0)) ||
            rock_in(v - ivec3(0, 1, 0)) || rock_in(v + ivec3(0, 0, 1)) || rock_in(v - ivec3(0, 0, 1)))
            left = -LOAD_F(viability, i);
    }
    AT(beyond, i) = left;
}
