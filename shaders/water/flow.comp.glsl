#version 460
#extension GL_GOOGLE_include_directive : require
// Per span, one round of accumulation: a span passes its rain on, split by its shares, in the round after its
// last donor has. Integer sums: the result does not depend on the order.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, to)
READ_U(1, shares)
WRITE_U(2, when)  // the round in which each gives
WRITE_U(3, waits) // for how many spans
WRITE_U(4, sum)
WRITE_U(5, counts)
PARAMS(water_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n || AT(when, i) != k.round)
        return;
    uint own = AT(sum, i), low_shares = LOAD_U(shares, 2u * i), high_shares = LOAD_U(shares, 2u * i + 1u);
    uvec4 share = uvec4(low_shares & 0xffffu, low_shares >> 16u, high_shares & 0xffffu, high_shares >> 16u), part, high, low;
    umulExtended(uvec4(own), share, high, low);
    part = high << 17u | low >> 15u;
    uint rest = own - (part.x + part.y + part.z + part.w), most = max(max(share.x, share.y), max(share.z, share.w));
    for (uint d = 0u; d < 4u; d++) {
        if (share[d] == 0u)
            continue;
        uint m = LOAD_U(to, 4u * i + d), more = part[d];
        if (share[d] == most) { // the largest share, of equals the first, gets the remainder of rounding
            more += rest;
            rest = 0u;
        }
        atomicAdd(AT(sum, m), more);
        if (atomicAdd(AT(waits, m), 0xffffffffu) == 1u) {
            AT(when, m) = k.round + 1u;
            AT(counts, COUNT_CHANGED) = k.round + 1u;
        }
    }
}
