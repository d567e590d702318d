#version 460
#extension GL_GOOGLE_include_directive : require
// Which bricks are kept: those with samples FIELD_REACH or nearer to anything. Farther off the share is 0 and the distance that of
// the band's end: the share is of neighbours, the surface lies between those, and the band is 3 wide from there.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, extent)
WRITE_U(1, held)
PARAMS(field_params)
#include "field/lattice.glsl"

const int FIELD_REACH = 5;

void main()
{
    uint brick = THREAD;
    if (brick >= k.n)
        return;
    ivec3 own = brick_first(brick), last = ivec3(bricks_across()) - 1;
    ivec3 from = max((own >> 3) - 1, ivec3(0)), to = min((own >> 3) + 1, last);
    bool near = false;
    for (int z = from.z; z <= to.z; z++)
        for (int y = from.y; y <= to.y; y++)
            for (int x = from.x; x <= to.x; x++) {
                ivec3 first = ivec3(x, y, z) << 3;
                uint e = LOAD_U(extent, brick_of(first));
                ivec3 low = first + ivec3(e & 7u, (e >> 3) & 7u, (e >> 6) & 7u) - FIELD_REACH;
                ivec3 high = first + ivec3((e >> 9) & 7u, (e >> 12) & 7u, (e >> 15) & 7u) + FIELD_REACH;
                near = near || (e != 0u && all(lessThanEqual(low, own + 7)) && all(greaterThanEqual(high, own)));
            }
    AT(held, brick) = near ? 1u : 0u;
}
