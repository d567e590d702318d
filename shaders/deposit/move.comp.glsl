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
READ_U(2, receiver)
READ_U(3, pointer)
READ_U(4, room)
READ_U(5, bits)
WRITE_U(6, cell)
WRITE_U(7, place)
WRITE_U(8, key)
PARAMS(deposit_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "shared/random.glsl"
#include "deposit/grid.glsl"
#include "deposit/column.glsl"
#include "deposit/slope.glsl"

const int NEAR = 64; // cells

// The cell of the ground that lies `drop` lower (in four columns) beside the cell with this top: over rock, or
// where a fall ends.
uint ground(ivec3 c, int top, uint drop)
{
    c.z = (top - 1 - int(drop >> 2) + k.sz) >> 1;
    if (!cell_inside(c))
        return 0xffffffffu;
    uint i = cell_index(c), kind = LOAD_U(tag, i) & WATER_KIND;
    if (kind == WATER_SURF)
        return i;
    uint above = i + k.cx * k.cy;
    if (kind != WATER_EMPTY && c.z + 1 < int(k.cz) && (LOAD_U(tag, above) & WATER_KIND) == WATER_SURF)
        return above;
    return LOAD_U(receiver, i);
}

uint next(uint c, uint hash)
{
    if ((LOAD_U(tag, c) & (WATER_KIND | WATER_OUT)) != WATER_SURF)
        return LOAD_U(receiver, c);
    ivec3 at = cell_at(c), base = cell_base(at);
    int top = cell_top(base);
    uvec4 drop = drops(base, top);
    uint sum = drop.x + drop.y + drop.z + drop.w, pick = random_below(hash, sum), to;
    if (sum == 0u)
        return LOAD_U(receiver, c);
    if (pick < drop.x)
        to = ground(at + ivec3(1, 0, 0), top, drop.x);
    else if (pick < drop.x + drop.y)
        to = ground(at - ivec3(1, 0, 0), top, drop.y);
    else if (pick < sum - drop.w)
        to = ground(at + ivec3(0, 1, 0), top, drop.z);
    else
        to = ground(at - ivec3(0, 1, 0), top, drop.w);
    return to == 0xffffffffu ? LOAD_U(receiver, c) : to;
}

// The next cell with room on the way from c on. In the first round all may have far to go: the pointers know.
// Later only those move whose cell has filled up, and a cell with room is near; what is not, they come to in the
// round after.
uint onwards(uint c)
{
    if (k.round == 0u)
        return LOAD_U(pointer, c);
    for (int s = 0; s < NEAR && LOAD_U(room, c) == 0u; s++) {
        uint to = LOAD_U(receiver, c);
        if (to == c)
            break;
        c = to;
    }
    return c;
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
            c = onwards(next(c, random_hash(k.seed, LOAD_U(crumb_id, i), k.round, 0u)));
        AT(cell, i) = c;
        if ((LOAD_U(tag, c) & WATER_OUT) != 0u)
            AT(place, i) = DEPOSIT_LEFT;
        else
            to = c;
    }
    AT(key, i) = to;
}
