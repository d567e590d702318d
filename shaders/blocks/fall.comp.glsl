#version 460
#extension GL_GOOGLE_include_directive : require
// A particle stays if its voxel, or one across a face of it, belongs to a block that stands on the ground.
// The others are taken out. Deposits lie loose, grain by grain: they stay if the rock that the column of deposits
// below them lies on stays, however thin it is; what lies on nothing is deposition's to move.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
READ_U(1, solid)
READ_U(2, root)
READ_U(3, start)
READ_U(4, phase)
WRITE_F(5, viability)
WRITE_U(6, counts)
PARAMS(voxel_params)
#include "particles/voxel.glsl"

bool stands(ivec3 v)
{
    if (!voxel_inside(v))
        return false;
    uint i = voxel_index(v);
    return LOAD_U(solid, i) != 0u && LOAD_U(root, i) < k.nx * k.ny;
}

bool holds(ivec3 v)
{
    return stands(v) || stands(v - ivec3(0, 0, 1)) || stands(v + ivec3(0, 0, 1)) || stands(v - ivec3(1, 0, 0)) ||
           stands(v + ivec3(1, 0, 0)) || stands(v - ivec3(0, 1, 0)) || stands(v + ivec3(0, 1, 0));
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 v = voxel_of(LOAD_V(position, i).xyz);
    bool stays = holds(v), loose = LOAD_U(phase, i) == 1u;
    for (v.z--; !stays && loose; v.z--) {
        uint c = v.z < 0 ? 0u : voxel_index(v), first = LOAD_U(start, c);
        if (v.z < 0 || first == LOAD_U(start, c + 1u))
            stays = true;
        else {
            loose = LOAD_U(phase, first) == 1u;
            stays = holds(v);
        }
    }
    if (stays)
        return;
    AT(viability, i) = 0.0;
    atomicAdd(AT(counts, COUNT_FALLEN), 1u);
}
