#version 460
#extension GL_GOOGLE_include_directive : require
// Crumbs that cannot stay go on to the next cell where they may land: from the ground to one of the lower cells
// beside it, as likely as it is lower, and on along the pointers. Those whose way ends where nothing may land
// have left if it is the domain's edge, else they wait. The key is a crumb's cell, or the number of cells for
// those that wait no longer.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, crumb_id)
READ_U(1, tag)
READ_U(2, altitude)
READ_U(3, receiver)
READ_U(4, pointer)
READ_U(5, room)
WRITE_U(6, cell)
WRITE_U(7, place)
WRITE_U(8, key)
PARAMS(deposit_params)
#include "particles/voxel.glsl"
#include "shared/random.glsl"
#include "deposit/grid.glsl"

// The ground that a crumb reaches from cell c by a step to the side, and how much lower it is; 0: not at all.
uint lower(ivec3 c, uint z, out uint to)
{
    to = 0u;
    if (!cell_inside(c))
        return 0u;
    to = cell_index(c);
    uint kind = LOAD_U(tag, to) & WATER_KIND;
    if (kind == WATER_EMPTY)
        to = LOAD_U(receiver, to);
    else if (kind != WATER_SURF)
        return 0u;
    uint there = LOAD_U(altitude, to);
    return there < z ? min(z - there, 0xfffffu) : 0u;
}

uint next(uint c, uint hash)
{
    if ((LOAD_U(tag, c) & WATER_KIND) != WATER_SURF)
        return LOAD_U(receiver, c);
    ivec3 at = cell_at(c);
    uint z = LOAD_U(altitude, c);
    uvec4 to, drop;
    drop.x = lower(at + ivec3(1, 0, 0), z, to.x);
    drop.y = lower(at - ivec3(1, 0, 0), z, to.y);
    drop.z = lower(at + ivec3(0, 1, 0), z, to.z);
    drop.w = lower(at - ivec3(0, 1, 0), z, to.w);
    uint sum = drop.x + drop.y + drop.z + drop.w;
    if (sum == 0u)
        return LOAD_U(receiver, c);
    uint pick = random_below(hash, sum);
    if (pick < drop.x)
        return to.x;
    pick -= drop.x;
    if (pick < drop.y)
        return to.y;
    return pick - drop.y < drop.z ? to.z : to.w;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint to = k.cx * k.cy * k.cz;
    if (AT(place, i) == DEPOSIT_WAITS) {
        uint c = AT(cell, i);
        if (k.round == 0u || LOAD_U(room, c) == 0u)
            c = LOAD_U(pointer, next(c, random_hash(k.seed, LOAD_U(crumb_id, i), k.round, 0u)));
        AT(cell, i) = c;
        if ((LOAD_U(tag, c) & WATER_OUT) != 0u)
            AT(place, i) = DEPOSIT_LEFT;
        else
            to = c;
    }
    AT(key, i) = to;
}
