#version 460
#extension GL_GOOGLE_include_directive : require
// Per ground cell: of its deposits that rest on too steep a slope, the one on the highest column becomes a
// fragment. The angle at which deposits start to slide is larger than that at which they come to rest, as for
// sand, so that what has landed does not slide at once. The slope is measured around the deposit's own column
// and not in routing cells, so that a heap at rest stays at rest until something near it changes.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, bits)
READ_U(2, start)
READ_U(3, phase)
WRITE_U(4, crumb)
WRITE_U(5, counts)
READ_U(6, words)
PARAMS(deposit_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"
#include "deposit/grid.glsl"
#include "deposit/column.glsl"

const float STEEP = 0.25;         // tangent beyond that of repose at which deposits begin to slide: 8 degrees for scree at 34
const int STEEP_REACH = 2;        // columns to each side whose heights the slope is fitted to
const float STEEP_SQUARES = 50.0; // sum of the squares of their distances along an axis
const int STEEP_DROP = 3;         // voxels: a deposit beside a step of this height slides, and higher steps count as this

// Drop along an offset, from the drops to both of its ends: their mean, or where one end is up a wall only that to the other.
float along(int a, int b, float far)
{
    float down = float(min(max(a, b), STEEP_DROP)), up = -float(min(a, b));
    float drop = up > 2.0 * k.repose * far + 0.5 ? max(down, 0.0) : 0.5 * (down + up);
    return a > b ? drop : -drop;
}

// Whether a deposit below the free voxel z of a column is on too steep a slope.
bool steep(int x, int y, int z)
{
    vec2 gradient = vec2(0.0);
    for (int dy = 0; dy <= STEEP_REACH; dy++)
        for (int dx = dy == 0 ? 1 : -STEEP_REACH; dx <= STEEP_REACH; dx++) {
            int a = -floor_near(x + dx, y + dy, z), b = -floor_near(x - dx, y - dy, z);
            if (max(a, b) >= STEEP_DROP && max(abs(dx), dy) == 1)
                return true;
            gradient += 2.0 * vec2(dx, dy) * along(a, b, length(vec2(dx, dy)));
        }
    return length(gradient) / STEEP_SQUARES > k.repose + STEEP;
}

// Updates `found` with the deposit on top of a column of the cell if that is too steep and higher than those before.
void look(ivec3 base, int x, int y, inout int highest, inout uint found)
{
    int z = floor_in(base.x + x, base.y + y, base.z) - 1;
    ivec3 v = ivec3(base.x + x, base.y + y, z);
    if (z <= highest || z < base.z || z > base.z + 1 || !voxel_inside(v))
        return;
    uint on_top = 0xffffffffu;
    uvec2 in_voxel = voxel_particles(v);
    for (uint j = in_voxel.x; j < in_voxel.y; j++)
        if (LOAD_U(phase, j) == PHASE_DEPOSIT && AT(crumb, j) == 0u)
            on_top = j;
    if (on_top != 0xffffffffu && steep(v.x, v.y, z + 1)) {
        highest = z;
        found = on_top;
    }
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 base = cell_base(cell_at(LOAD_U(list, i)));
    int highest = -1;
    uint found = 0xffffffffu;
    look(base, 0, 0, highest, found);
    look(base, 1, 0, highest, found);
    look(base, 0, 1, highest, found);
    look(base, 1, 1, highest, found);
    if (found != 0xffffffffu) {
        AT(crumb, found) = 1u;
        atomicAdd(AT(counts, COUNT_SLID), 1u);
    }
}
