#version 460
#extension GL_GOOGLE_include_directive : require
// Per bare surface deposit, cover's advance by one voxel: a seedling if a voxel around it is covered. Seen from
// above, neighbours along the axes always count and diagonal ones with a hashed chance that makes the front
// round.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_U(2, phase)
READ_U(3, start)
READ_F(4, before)
READ_U(5, id)
WRITE_F(6, vegetation)
READ_U(7, words)
PARAMS(plants_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"
#include "particles/empty.glsl"
#include "plants/stand.glsl"
#include "shared/random.glsl"

const float WIDE = 0.2; // chance with which diagonal neighbours count; measured, for a round front

bool covered(ivec3 v)
{
    if (!voxel_inside(v))
        return false;
    uvec2 in_voxel = voxel_particles(v);
    for (uint j = in_voxel.x; j < in_voxel.y; j++)
        if (LOAD_F(before, j) > 0.0)
            return true;
    return false;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    if (LOAD_U(phase, self) != 1u || LOAD_F(before, self) > 0.0)
        return;
    vec3 x = LOAD_V(position, self).xyz;
    ivec3 v = voxel_of(x);
    bool wide = random_float(random_hash(k.seed, LOAD_U(id, self), k.spread, 0u)) < WIDE;
    bool found = false;
    for (int z = -1; z <= 1; z++)
        for (int y = -1; y <= 1; y++)
            for (int s = -1; s <= 1; s++)
                if (!found && (wide || s == 0 || y == 0))
                    found = covered(v + ivec3(s, y, z));
    if (found && stands(x))
        AT(vegetation, self) = SEEDLING;
}
