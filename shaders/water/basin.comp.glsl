#version 460
#extension GL_GOOGLE_include_directive : require
// Per span: the number of the basin it drains to, that of its pit; `basins` if it drains out of the domain.
// Flags the spans that own a pass to another basin.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, root)
READ_U(1, place)
READ_U(2, pass)
WRITE_U(3, basin)
WRITE_U(4, border)
PARAMS(water_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint own = LOAD_U(root, i), differ = 0u;
    AT(basin, i) = own == k.nodes ? k.basins : LOAD_U(place, own);
    for (uint d = 0u; d < 4u; d++) {
        uint m = LOAD_U(pass, 4u * i + d);
        if (m != 0xffffffffu && LOAD_U(root, m) != own)
            differ = 1u;
    }
    AT(border, i) = differ;
}
