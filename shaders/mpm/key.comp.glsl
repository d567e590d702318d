#version 460
#extension GL_GOOGLE_include_directive : require
// A particle's sort key: its base cell, or the number of cells for those that have left the domain or of which
// nothing is left.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, place)
READ_F(1, share)
WRITE_U(2, key)
PARAMS(mpm_params)
#include "mpm/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    vec3 x = LOAD_V(place, i).xyz;
    bool gone = LOAD_F(share, i) <= 0.0 || !mpm_in_domain(x);
    uint none = (k.cx + 3u) * (k.cy + 3u) * (k.cz + 3u);
    AT(key, i) = gone ? none : mpm_index(ivec3(floor(mpm_cells(x) - 0.5)) + 1);
}
