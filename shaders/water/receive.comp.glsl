#version 460
#extension GL_GOOGLE_include_directive : require
// Per span: its initial receiver, and the passes it owns: to the empty cells beside its floor, and of the SURF
// cells at its own level to those at +x and +y. The last invocation is the outside. Rules: water/water.h.
#include "shared/buffers.glsl"
#include "shared/params.h"
#include "shared/random.glsl"

READ_U(0, occupied)
READ_U(1, floors)
READ_U(2, first)
READ_U(3, cell)
READ_U(4, altitude)
WRITE_U(5, pass)
WRITE_U(6, receiver)
WRITE_U(7, root)
PARAMS(water_params)
#include "water/cell_of.glsl"
#include "water/columns.glsl"
#include "water/side.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    if (i == k.nodes) {
        AT(receiver, i) = i;
        AT(root, i) = i;
        return;
    }
    uint at = LOAD_U(cell, i), own = LOAD_U(altitude, i), column;
    uvec3 c = cell_of(at);
    column = c.y * k.cx + c.x;
    bool ground = !is_occupied(column, c.z);
    uint beside[4], fall[4];
    uint drop = 0u;
    for (int d = 0; d < 4; d++) {
        ivec2 to = ivec2(c.xy) + (d == 0 ? ivec2(1, 0) : d == 1 ? ivec2(0, 1) : d == 2 ? ivec2(-1, 0) : ivec2(0, -1));
        bool inside = to.x >= 0 && to.y >= 0 && to.x < int(k.cx) && to.y < int(k.cy) && !ground;
        uint other = inside ? uint(to.y) * k.cx + uint(to.x) : column, m = inside ? node_at(other, c.z) : NONE;
        bool air = m != NONE && !is_occupied(other, c.z);
        beside[d] = m;
        fall[d] = m != NONE ? uint(clamp(int(own) - int(LOAD_U(altitude, m)), 0, WATER_FALL)) : 0u;
        drop += fall[d];
        AT(pass, 4u * i + uint(d)) = air || d < 2 ? m : NONE;
    }
    uint to = i;
    // Water takes each direction as often as its drop says, by turns: chosen at random it would wander where it runs across the
    // grid but not where it runs along it. Fragments are chosen at random, so that they spread.
    int turn = (fall[0] < fall[2] ? -int(c.x) : int(c.x)) + (fall[1] < fall[3] ? -int(c.y) : int(c.y));
    uint hash = k.size == 1u ? random_hash(k.random, 0u, 0u, RANDOM_RECEIVER) + WATER_TURN * uint(turn)
                             : random_hash(k.random, at, 0u, RANDOM_RECEIVER);
    if (ground || is_side(c)) {
        to = k.nodes;
    } else if (k.leak != 0u && c.z > 0u && !is_occupied(column, c.z - 1u)) {
        to = node_at(column, c.z - 1u);
    } else if (drop > 0u) {
        int left = int(random_below(hash, drop));
        for (int d = 0; d < 4; d++) {
            if (left >= 0 && left < int(fall[d]))
                to = beside[d];
            left -= int(fall[d]);
        }
    }
    AT(receiver, i) = to;
    AT(root, i) = to;
}
