#version 460
#extension GL_GOOGLE_include_directive : require
// Per span: splits its rain between the four neighbours in proportion to how much lower their water level is,
// in shares of WATER_WHOLE. On a plane this is flow along the gradient at any angle to the grid. Where no
// neighbour is lower (in a pit, up to its pass) all goes to the receiver. Water never moves to a higher level,
// and on one level it follows the receivers, so there are no cycles. Water without a way out, between walls on
// all sides, stays in its pits.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, occupied)
READ_U(1, floors)
READ_U(2, first)
READ_U(3, cell)
READ_U(4, altitude)
READ_U(5, basin)
READ_U(6, spill)
READ_U(7, receiver)
WRITE_U(8, level)   // of the water: altitude of the floor or, in a pit, of the highest pass on its path out
WRITE_U(9, to)     // [4]: receiving spans, or NONE
WRITE_U(10, shares) // [2]: four shares, two to a word
WRITE_U(11, heading) // [2]: directions of rain and of springs, packSnorm2x16
WRITE_U(12, donors) // number of donors
PARAMS(water_params)
#include "water/cell_of.glsl"
#include "water/columns.glsl"
#include "water/side.glsl"

const ivec2 WAY[4] = ivec2[4](ivec2(1, 0), ivec2(0, 1), ivec2(-1, 0), ivec2(0, -1));

uint level_of(uint node)
{
    return max(LOAD_U(altitude, node), LOAD_U(spill, LOAD_U(basin, node)));
}

// Direction out of the domain for a cell at its open sides, else 0.
vec2 outward(uvec3 c)
{
    vec4 at = vec4(open_sides(c));
    vec2 way = at.yw - at.xz;
    return way / max(abs(way.x) + abs(way.y), 1.0);
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uvec3 c = cell_of(LOAD_U(cell, i));
    uint column = c.y * k.cx + c.x, own = LOAD_U(altitude, i), single = LOAD_U(receiver, i);
    bool ground = !is_occupied(column, c.z);
    bool drips = k.leak != 0u && c.z > 0u && !ground && !is_occupied(column, c.z - 1u);
    uint stands = level_of(i), next[4], drop[4], highest = 0u;
    AT(level, i) = stands;
    vec2 spring = single == k.nodes ? outward(c) : vec2(0.0);
    for (int d = 0; d < 4; d++) {
        ivec2 at = ivec2(c.xy) + WAY[d];
        bool inside = at.x >= 0 && at.y >= 0 && at.x < int(k.cx) && at.y < int(k.cy) && !ground;
        uint m = inside ? node_at(uint(at.y) * k.cx + uint(at.x), c.z) : NONE;
        if (m != NONE && m == single)
            spring = vec2(WAY[d]);
        bool lower = m != NONE && !drips && stands == own && single != k.nodes;
        drop[d] = lower ? uint(clamp(int(own) - int(level_of(m)), 0, WATER_FALL)) : 0u;
        next[d] = m;
        highest = max(highest, drop[d]);
    }
    vec2 rain = spring;
    uint share[4] = uint[4](0u, 0u, 0u, 0u);
    if (highest > 0u) {
        int shift = max(findMSB(highest) - 14, 0), most = 0;
        uint sum = 0u, given = 0u;
        for (int d = 0; d < 4; d++) {
            drop[d] >>= shift;
            sum += drop[d];
            if (drop[d] > drop[most])
                most = d;
        }
        for (int d = 0; d < 4; d++) {
            share[d] = drop[d] * WATER_WHOLE / sum;
            given += share[d];
        }
        share[most] += WATER_WHOLE - given;
        rain = vec2(0.0);
        for (int d = 0; d < 4; d++)
            rain += float(share[d]) / float(WATER_WHOLE) * vec2(WAY[d]);
    } else if (single != k.nodes && single != i) {
        share[0] = WATER_WHOLE;
        next[0] = single;
    }
    for (int d = 0; d < 4; d++) {
        AT(to, 4u * i + uint(d)) = share[d] > 0u ? next[d] : NONE;
        if (share[d] > 0u)
            atomicAdd(AT(donors, next[d]), 1u);
    }
    AT(shares, 2u * i) = share[0] | share[1] << 16u;
    AT(shares, 2u * i + 1u) = share[2] | share[3] << 16u;
    AT(heading, 2u * i) = packSnorm2x16(rain);
    AT(heading, 2u * i + 1u) = packSnorm2x16(spring);
}
