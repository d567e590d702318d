#version 460
#extension GL_GOOGLE_include_directive : require
// Where each crumb would land now: on from where it broke off, from the ground to one of the lower cells beside it, as likely as
// it is lower, to the first cell that takes crumbs; and if that is far, along the pointers. Where more come than it takes, the
// others look again in the next round, over the ground as it has risen: so many that come at once lie as they would if they had
// come one after another. Those whose way ends where nothing may land have left if it is the domain's edge, else they wait. The
// key is the cell, or the number of cells for those that wait no longer. In the last round what has eroded waits for the next
// landing; the rest, and all if there is to be none, lands where its way ends.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, crumb_id)
READ_U(1, tag)
READ_U(2, receiver)
READ_U(3, pointer)
READ_U(4, bits)
READ_U(5, cell)
WRITE_U(6, place)
WRITE_U(7, key)
READ_U(8, particle)
READ_F(9, viability)
READ_U(10, room)
PARAMS(deposit_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "shared/random.glsl"
#include "deposit/grid.glsl"
#include "deposit/column.glsl"
#include "deposit/slope.glsl"

const uint NEAR = 64u; // cells

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

// Where the way of crumb i ends for now.
uint way_end(uint i, uint c)
{
    uint id = LOAD_U(crumb_id, i);
    for (uint s = 0u; s < NEAR; s++) {
        uint to = next(c, random_hash(k.seed, id, k.round, s));
        if (to == c || LOAD_U(room, to) > 0u || (LOAD_U(tag, to) & WATER_OUT) != 0u)
            return to;
        c = to;
    }
    return LOAD_U(pointer, c);
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint none = k.cx * k.cy * k.cz, to = none;
    if (AT(place, i) == DEPOSIT_WAITS) {
        to = LOAD_U(cell, i);
        if (k.last == 1u && LOAD_F(viability, LOAD_U(particle, i)) <= 0.0) {
            AT(place, i) = DEPOSIT_HELD;
            to = none;
        } else {
            to = way_end(i, to);
            if ((LOAD_U(tag, to) & WATER_OUT) != 0u) {
                AT(place, i) = DEPOSIT_LEFT;
                to = none;
            }
        }
    }
    AT(key, i) = to;
}
