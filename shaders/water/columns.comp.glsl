#version 460
#extension GL_GOOGLE_include_directive : require
// 32 levels of a column of cells as bits, and how many spans begin in them. See water/columns.glsl.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, start)
WRITE_U(1, occupied)
WRITE_U(2, floors)
WRITE_U(3, count)
PARAMS(water_params)
#include "water/voxels.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint x = i % k.cx, y = (i / k.cx) % k.cy, word = i / (k.cx * k.cy);
    uvec3 low, high;
    cell_voxels(uvec3(x, y, 0u), low, high);
    uint near = low.y * k.vx, far = (high.y - 1u) * k.vx, bits = 0u;
    bool over = false; // the level above these
    for (uint l = 0u; l < 33u; l++) {
        uint z = word * 32u + l;
        if (z >= k.cz)
            break;
        uint lower = uint(max(2 * int(z) - int(k.sz), 0)) * k.vx * k.vy;
        uint upper = min(2u * z - k.sz + 1u, k.vz - 1u) * k.vx * k.vy;
        over = LOAD_U(start, lower + near + low.x) != LOAD_U(start, lower + near + high.x) ||
               LOAD_U(start, lower + far + low.x) != LOAD_U(start, lower + far + high.x) ||
               LOAD_U(start, upper + near + low.x) != LOAD_U(start, upper + near + high.x) ||
               LOAD_U(start, upper + far + low.x) != LOAD_U(start, upper + far + high.x);
        if (over && l < 32u)
            bits |= 1u << l;
        if (l < 32u)
            over = false;
    }
    uint bottoms = bits & ~(bits >> 1u | (over ? 1u << 31u : 0u));
    if (word == 0u && (bits & 1u) == 0u)
        bottoms |= 1u;
    uint at = (y * k.cx + x) * k.words + word;
    AT(occupied, at) = bits;
    AT(floors, at) = bottoms;
    AT(count, at) = uint(bitCount(bottoms));
}
