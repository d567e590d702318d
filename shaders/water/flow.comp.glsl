#version 460
#extension GL_GOOGLE_include_directive : require
// Per span of the list `passing`, one round of accumulation: the span passes its rain on to its receivers, split by its shares. A
// receiver whose last donor this was is listed for the next round. The order of a list is that of the threads, but integer sums do
// not depend on it. There may be fewer threads than spans.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, to)
READ_U(1, shares)
READ_U(2, passing)
WRITE_U(3, next)
WRITE_U(4, waits)  // by span: donors that have not passed on yet
WRITE_U(5, sum)
WRITE_U(6, length) // of the lists, by round modulo 3: this one's, the next one's, and one to be cleared for the round after that; and of all
PARAMS(water_params)

void pass_on(uint i)
{
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
        if (atomicAdd(AT(waits, m), 0xffffffffu) == 1u && m != k.nodes)
            AT(next, atomicAdd(AT(length, (k.round + 1u) % 3u), 1u)) = m;
    }
}

void main()
{
    if (THREAD >= k.n)
        return;
    uint n = AT(length, k.round % 3u);
    if (THREAD == 0u) {
        AT(length, (k.round + 2u) % 3u) = 0u;
        AT(length, 3) += n;
    }
    for (uint i = THREAD; i < n; i += k.n)
        pass_on(LOAD_U(passing, i));
}
