#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle: discharge of the floor it belongs to, or of the floors beside it that it is at most
// STEP voxels above. Stays 0 on ceilings.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_U(2, occupied)
READ_U(3, floors)
READ_U(4, first)
READ_U(5, cell)
READ_V(6, pull)
WRITE_F(7, discharge)
PARAMS(water_surface_params)
#include "particles/voxel.glsl"
#include "water/columns.glsl"
#include "water/floor.glsl"

const int STEP = 2; // voxels

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i), node;
    ivec3 v = voxel_of(LOAD_V(position, self).xyz);
    float most = 0.0;
    if ((node = floor_at(v)) != NONE)
        most = LOAD_V(pull, node).w;
    else
        for (int d = 0; d < 4; d++) {
            ivec3 to = v + ivec3(d == 0 ? 1 : d == 2 ? -1 : 0, d == 1 ? 1 : d == 3 ? -1 : 0, 0);
            if (!voxel_inside(to) || !voxel_empty(to))
                continue;
            node = node_at(uint(to.y) * k.nx + uint(to.x), uint(to.z));
            if (to.z - int(LOAD_U(cell, node) / (k.nx * k.ny)) <= STEP)
                most = max(most, LOAD_V(pull, node).w);
        }
    AT(discharge, self) = most;
}
