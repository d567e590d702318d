#version 460
#extension GL_GOOGLE_include_directive : require
// Per cell: its kind, altitude and receiver, for callers that work with cells instead of spans (water/water.h).
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
#include "water/cell_of.glsl"
#include "water/columns.glsl"
#include "water/side.glsl"

uint to_cell(uint node, uint self)
{
    return node == k.nodes ? self : LOAD_U(cell, node);
}

bool is_live(uint node)
{
    return LOAD_U(component, LOAD_U(basin, node)) == k.basins;
}

// Rock drains to an empty cell below it, else to a random one of those beside it; without any it is SOLID.
void rock(uint i, uvec3 c, uint column, out uint kind, out uint to)
{
    kind = WATER_SOLID;
    to = i;
    if (is_side(c)) {
        kind = WATER_WALL | WATER_OUT;
        return;
    }
    uint node = NONE;
    if (c.z > 0u && !is_occupied(column, c.z - 1u)) {
        node = node_at(column, c.z - 1u);
    } else {
        uint column_at[4] = uint[4](column + 1u, column + k.cx, column - 1u, column - k.cx);
        bool within[4] = bool[4](c.x + 1u < k.cx, c.y + 1u < k.cy, c.x > 0u, c.y > 0u); // a wall is no air
        bool air[4];
        uint falls = 0u;
        for (int d = 0; d < 4; d++) {
            air[d] = within[d] && !is_occupied(column_at[d], c.z);
            falls += air[d] ? 1u : 0u;
        }
        int left = falls > 0u ? int(random_below(random_hash(k.random, i, 0u, RANDOM_RECEIVER), falls)) : 4;
        for (int d = 0; d < 4; d++)
            if (air[d]) {
                if (left == 0)
                    node = node_at(column_at[d], c.z);
                left--;
            }
    }
    if (node != NONE) {
        kind = WATER_WALL | (is_live(node) ? 0u : WATER_DEAD);
        to = LOAD_U(cell, node);
    }
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uvec3 c = cell_of(i);
    uint column = c.y * k.cx + c.x, node = node_at(column, c.z), kind, to, height = c.z << 16u;
    if (node == NONE) {
        rock(i, c, column, kind, to);
    } else {
        bool floors_it = LOAD_U(cell, node) == i;
        kind = is_occupied(column, c.z) ? WATER_SURF : WATER_EMPTY;
        if (kind == WATER_SURF)
            height = LOAD_U(altitude, node);
        if (is_side(c) || (floors_it && kind == WATER_EMPTY)) {
            kind |= WATER_OUT;
            to = i;
        } else {
            if (!is_live(node))
                kind |= WATER_DEAD;
            to = floors_it ? to_cell(LOAD_U(final, node), i) : LOAD_U(cell, node);
        }
    }
    AT(tag, i) = kind;
    AT(z, i) = height;
    AT(receiver, i) = to;
}
