#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: sort key, its base cell, or the number of cells if it has left the domain or nothing is left of
// it; and its group in the cell, its piece or the loose grains.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, place)
READ_F(1, share)
READ_F(2, apart)
READ_U(3, joint)
READ_U(4, piece)
WRITE_U(5, key)
WRITE_U(6, group)
PARAMS(mpm_params)
#include "mpm/broken.glsl"
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
    bool one = k.bodies == 0u || is_loose(LOAD_F(apart, i), LOAD_U(joint, i));
    AT(group, i) = one ? MPM_LOOSE : LOAD_U(piece, i);
}
