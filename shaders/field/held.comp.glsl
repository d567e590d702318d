#version 460
#extension GL_GOOGLE_include_directive : require
// Per brick: 1 if it is kept: if it has samples within FIELD_REACH both of rock and of what is not all rock.
// Farther away the share is 0 or 1 and the distance is at an end of the band (3 wide). Bricks that are not kept
// get a slot that says all outside or all inside.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, rock)
READ_U(1, bare)
WRITE_U(2, held)
WRITE_U(3, slot)
PARAMS(field_params)
#include "field/lattice.glsl"

const int FIELD_REACH = 5;

// Whether an extent in the brick that begins at `first` is within reach of the brick that begins at `own`.
bool comes_near(uint e, ivec3 first, ivec3 own)
{
    ivec3 low = first + ivec3(e & 7u, (e >> 3) & 7u, (e >> 6) & 7u) - FIELD_REACH;
    ivec3 high = first + ivec3((e >> 9) & 7u, (e >> 12) & 7u, (e >> 15) & 7u) + FIELD_REACH;
    return e != 0u && all(lessThanEqual(low, own + 7)) && all(greaterThanEqual(high, own));
}

void main()
{
    uint brick = THREAD;
    if (brick >= k.n)
        return;
    ivec3 own = brick_first(brick), last = ivec3(bricks_across()) - 1;
    ivec3 from = max((own >> 3) - 1, ivec3(0)), to = min((own >> 3) + 1, last);
    // Beyond the lattice there is no rock.
    bool near_rock = false, near_bare = any(equal(own >> 3, ivec3(0))) || any(equal(own >> 3, last));
    for (int z = from.z; z <= to.z; z++)
        for (int y = from.y; y <= to.y; y++)
            for (int x = from.x; x <= to.x; x++) {
                ivec3 first = ivec3(x, y, z) << 3;
                near_rock = near_rock || comes_near(LOAD_U(rock, brick_of(first)), first, own);
                near_bare = near_bare || comes_near(LOAD_U(bare, brick_of(first)), first, own);
            }
    AT(held, brick) = near_rock && near_bare ? 1u : 0u;
    AT(slot, brick) = near_rock && !near_bare ? SLOT_INSIDE : 0u;
}
