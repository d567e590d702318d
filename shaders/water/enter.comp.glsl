#version 460
#extension GL_GOOGLE_include_directive : require
// Per source: the node where its water enters: that of its cell, or the nearest with a way out, in cells; of
// equally near ones the first. Nodes at the open sides of the domain are outlets, so they are avoided where
// possible. Searches ever wider squares of columns.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, occupied)
READ_U(1, floors)
READ_U(2, first)
READ_U(3, basin)
READ_U(4, component)
READ_U(5, source) // x, y, z in voxels, amount
WRITE_U(6, entry) // span, squared distance in cells
PARAMS(water_params)
#include "water/columns.glsl"

const uint FAR = 0xffffffffu;

bool is_live(uint node)
{
    return LOAD_U(component, LOAD_U(basin, node)) == k.basins;
}

// Updates the nearest live span with those of a column at the squared distance `across`.
void look(uint column, uint z, uint across, inout uint best, inout uint nearest)
{
    for (uint up = 0u; up < k.cz; up++) {
        uint d = across + up * up;
        if (d > nearest)
            break;
        for (int side = -1; side <= 1; side += 2) {
            int level = int(z) + side * int(up);
            if (level < 0 || level >= int(k.cz))
                continue;
            uint node = node_at(column, uint(level));
            if (node != NONE && is_live(node) && (d < nearest || node < best)) {
                nearest = d;
                best = node;
            }
        }
    }
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec2 margin = ivec2(k.cx > 2u ? 1 : 0, k.cy > 2u ? 1 : 0), last = ivec2(k.cx, k.cy) - 1;
    ivec2 low = ivec2((k.walls & WALL_X_MIN) != 0u ? 0 : margin.x, (k.walls & WALL_Y_MIN) != 0u ? 0 : margin.y);
    ivec2 high = last - ivec2((k.walls & WALL_X_MAX) != 0u ? 0 : margin.x, (k.walls & WALL_Y_MAX) != 0u ? 0 : margin.y);
    uvec3 voxel = uvec3(LOAD_U(source, 4u * i), LOAD_U(source, 4u * i + 1u), LOAD_U(source, 4u * i + 2u));
    uvec3 c = (voxel + uvec3(k.sx, k.sy, k.sz)) / k.size;
    ivec2 middle = clamp(ivec2(c.xy), low, high);
    uint best = NONE, nearest = FAR, widest = max(k.cx, k.cy);
    for (uint r = 0u; r < widest && r * r <= nearest; r++)
        for (int y = -int(r); y <= int(r); y++) {
            int stride = r == 0u || abs(y) == int(r) ? 1 : 2 * int(r);
            for (int x = -int(r); x <= int(r); x += stride) {
                ivec2 at = middle + ivec2(x, y);
                if (all(greaterThanEqual(at, low)) && all(lessThanEqual(at, high)))
                    look(uint(at.y) * k.cx + uint(at.x), c.z, uint(x * x + y * y), best, nearest);
            }
        }
    AT(entry, 2u * i) = best;
    AT(entry, 2u * i + 1u) = nearest;
}
