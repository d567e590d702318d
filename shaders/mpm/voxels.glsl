// Voxels, eight to a cell. Needs mpm_params.
#define HELD_NX (2u * k.cx)
#define HELD_NY (2u * k.cy)
#include "particles/bits.glsl"

bool voxel_inside(ivec3 v)
{
    return all(greaterThanEqual(v, ivec3(0))) && all(lessThan(v, 2 * ivec3(k.cx, k.cy, k.cz)));
}
