#version 460
#extension GL_GOOGLE_include_directive : require
// Kind, altitude and receiver of every cell, for those who do not know of spans: 32 levels of a column, from
// below. See water/water.h.
#include "shared/buffers.glsl"
#include "shared/params.h"
#include "shared/random.glsl"

READ_U(0, occupied)
READ_U(1, floors)
READ_U(2, first)
READ_U(3, cell)
READ_U(4, altitude)
READ_U(5, final)
READ_U(6, basin)
READ_U(7, component)
WRITE_U(8, tag)
WRITE_U(9, z)
WRITE_U(10, receiver)
PARAMS(water_params)
#include "water/columns.glsl"

uint dead(uint node)
{
    return LOAD_U(component, LOAD_U(basin, node)) == k.basins ? 0u : WATER_DEAD;
}

uint neighbour(uint column, int d)
{
    return d == 0 ? column + 1u : d == 1 ? column + k.cx : d == 2 ? column - 1u : column - k.cx;
}

// The span beside a wall that what breaks off it falls into: one of those whose column has a bit in `air`.
uint beside(uint i, uint column, uint level, uint air)
{
    int left = int(random_below(random_hash(k.random, i, 0u, RANDOM_RECEIVER), uint(bitCount(air))));
    for (int d = 0; d < 4; d++)
        if ((air >> d & 1u) != 0u && left-- == 0)
            return node_at(neighbour(column, d), level);
    return NONE;
}

void main()
{
    uint t = THREAD;
    if (t >= k.n)
        return;
    uint x = t % k.cx, y = (t / k.cx) % k.cy, word = t / (k.cx * k.cy), column = y * k.cx + x, layer = k.cx * k.cy;
    uint at = column * k.words + word, rocky = LOAD_U(occupied, at), bottoms = LOAD_U(floors, at);
    bool side = is_side(uvec3(x, y, 0u));
    uint around[4];
    for (int d = 0; d < 4; d++)
        around[d] = side ? 0xffffffffu : LOAD_U(occupied, neighbour(column, d) * k.words + word);

    // The span below, and whether what is in it cannot get out.
    uint node = LOAD_U(first, at) - 1u, floor_cell = 0u, lost = 0u;
    bool air_below = word > 0u && !is_occupied(column, 32u * word - 1u);
    if (air_below || (word > 0u && (rocky & 1u) == 0u)) {
        floor_cell = LOAD_U(cell, node);
        lost = dead(node);
    }
    for (uint l = 0u; l < 32u && 32u * word + l < k.cz; l++) {
        uint level = 32u * word + l, i = level * layer + column, kind = WATER_EMPTY, to = i, height = level << 16u;
        bool rock = (rocky >> l & 1u) != 0u;
        if ((bottoms >> l & 1u) != 0u) {
            node++;
            floor_cell = i;
            lost = dead(node);
            uint next = LOAD_U(final, node);
            if (next != k.nodes)
                to = LOAD_U(cell, next);
            if (rock)
                height = LOAD_U(altitude, node);
            kind = rock ? WATER_SURF | lost : WATER_EMPTY | WATER_OUT;
        } else if (!rock) {
            to = floor_cell;
            kind = WATER_EMPTY | lost;
        } else {
            uint air = 0u;
            for (int d = 0; d < 4; d++)
                air |= (~around[d] >> l & 1u) << d;
            kind = WATER_SOLID;
            if (air_below) {
                to = floor_cell;
                kind = WATER_WALL | lost;
            } else if (air != 0u) {
                uint other = beside(i, column, level, air);
                to = LOAD_U(cell, other);
                kind = WATER_WALL | dead(other);
            }
        }
        if (side) {
            to = i;
            kind = (kind & WATER_KIND) == WATER_SOLID ? WATER_WALL | WATER_OUT : (kind & WATER_KIND) | WATER_OUT;
        }
        AT(tag, i) = kind;
        AT(z, i) = height;
        AT(receiver, i) = to;
        air_below = !rock;
    }
}
