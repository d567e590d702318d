#version 460
#extension GL_GOOGLE_include_directive : require
// Per fragment, one round: follows its path from where it broke off to the first cell that accepts fragments,
// and writes that cell as the sort key (the number of cells if it no longer waits). From ground it goes to one
// of the lower cells beside, with probability proportional to the drop; after NEAR steps it follows the
// pointers. Where more fragments arrive than a cell accepts, the rest try again in the next round over the
// risen ground, so that many at once settle as they would one after another. A path that ends at an outlet
// leaves the domain. In the last round eroded fragments wait for the next landing and the others settle where
// their path ends; if no landing follows, all do.
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

// The ground cell in the neighbouring column of cells that is `drop` lower (summed over four columns) than `top`: on rock, or where
// a fall ends.
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

// Where the path of fragment i ends in this round.
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
