#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: 1 if it is a fragment: its viability is used up, or it is a deposit with nothing but deposits
// below and these with nothing below them.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, viability)
READ_V(1, position)
READ_U(2, phase)
READ_U(3, start)
WRITE_U(4, crumb)
READ_U(5, words)
PARAMS(deposit_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"

// Content of a voxel: 0 nothing, 1 only deposits, 2 rock.
uint inside(ivec3 v)
{
    uvec2 in_voxel = voxel_particles(v);
    uint most = voxel_deep(v) ? 2u : 0u;
    for (uint j = in_voxel.x; j < in_voxel.y; j++)
        if (LOAD_F(viability, j) != 0.0) // waiting fragments (viability < 0) still count
            most = max(most, LOAD_U(phase, j) == 1u ? 1u : 2u);
    return most;
}

bool hangs(ivec3 v)
{
    uint below = 1u;
    for (v.z--; v.z >= 0 && below == 1u; v.z--)
        below = inside(v);
    return below == 0u;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    bool loose = LOAD_F(viability, i) <= 0.0;
    if (!loose && LOAD_U(phase, i) == 1u)
        loose = hangs(voxel_of(LOAD_V(position, i).xyz));
    AT(crumb, i) = loose ? 1u : 0u;
}
