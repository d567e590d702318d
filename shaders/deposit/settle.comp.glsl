#version 460
#extension GL_GOOGLE_include_directive : require
// Per fragment, the first of each cell acting for all: fragments that wait in a cell land in it in the order of
// their ids, as many as it accepts. Each takes the column that is deepest below the mean of its neighbours, so
// that the ground becomes no rougher and keeps its slope. In the last round all that have arrived land where
// there is a free voxel.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, order)
READ_U(1, start)
READ_U(2, key)
READ_U(3, crumb_id)
READ_U(4, tag)
READ_U(5, room)
READ_U(6, bits)
WRITE_U(7, place)
PARAMS(deposit_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "shared/random.glsl"
#include "deposit/grid.glsl"
#include "deposit/column.glsl"
#include "deposit/floors.glsl"

int beside(int f, int z)
{
    return f == NOWHERE ? 0 : clamp(f - z, -16, 16);
}

// How far column q's floor is below those of the four columns beside it, summed.
int depth(ivec3 base, ivec4 f, int q)
{
    int x = q & 1, y = q >> 1, z = f[q];
    return beside(f[q ^ 1], z) + beside(f[q ^ 2], z) + floor_near(base.x + 3 * x - 1, base.y + y, z) +
           floor_near(base.x + x, base.y + 3 * y - 1, z);
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint c = LOAD_U(key, LOAD_U(order, i)), cells = k.cx * k.cy * k.cz;
    if (c == cells || LOAD_U(start, c) != i)
        return;
    uint end = LOAD_U(start, c + 1u);
    if (k.last == 0u)
        end = min(end, i + LOAD_U(room, c));
    ivec3 at = cell_at(c), base = cell_base(at);
    ivec4 f = floors(at, base);
    for (uint r = i; r < end; r++) {
        uint item = LOAD_U(order, r), hash = random_hash(k.seed, LOAD_U(crumb_id, item), 0u, 1u);
        int best = NOWHERE, found = -1;
        for (int q = 0; q < 4; q++) {
            if (f[q] == NOWHERE)
                continue;
            int score = -4 * depth(base, f, q) + int(hash >> (8 * q) & 3u);
            if (score < best) {
                best = score;
                found = q;
            }
        }
        if (found < 0)
            break;
        AT(place, item) = 1u + voxel_index(ivec3(base.x + (found & 1), base.y + (found >> 1), f[found]));
        f[found] = f[found] < ceiling(base) ? f[found] + 1 : NOWHERE;
    }
}
