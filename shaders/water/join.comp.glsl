#version 460
#extension GL_GOOGLE_include_directive : require
// Per component of basins, one round of Boruvka: it drains over the pass it picked. Where two components picked
// the same pass, the one with the smaller number stays. The basins' ways out between the pass and the
// component's old root are reversed; they stay within the component, so threads do not interfere.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, component)
READ_U(1, pick)
READ_U(2, pass)
READ_U(3, basin)
WRITE_U(4, next)
WRITE_U(5, from)
WRITE_U(6, to)
WRITE_U(7, flags)
PARAMS(water_params)

void main()
{
    uint c = THREAD;
    if (c >= k.n)
        return;
    uint number = c < k.basins && LOAD_U(component, c) == c ? LOAD_U(pick, c) : 0xffffffffu;
    uint drains = c;
    if (number != 0xffffffffu) {
        uint i = number >> 2u, j = LOAD_U(pass, number);
        if (LOAD_U(component, LOAD_U(basin, i)) != c) {
            uint swap = i;
            i = j;
            j = swap;
        }
        uint other = LOAD_U(component, LOAD_U(basin, j));
        if (other == k.basins || LOAD_U(pick, other) != number || c > other) {
            drains = other;
            uint b = LOAD_U(basin, i);
            for (uint step = 0u; step < k.basins; step++) {
                uint was_from = AT(from, b), was_to = AT(to, b);
                AT(from, b) = i;
                AT(to, b) = j;
                if (b == c)
                    break;
                i = was_to;
                j = was_from;
                b = LOAD_U(basin, i);
            }
            AT(flags, k.flag) = 1u;
        }
    }
    AT(next, c) = drains;
}
