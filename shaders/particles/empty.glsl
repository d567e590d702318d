// Whether a voxel has no particle. Beyond an open side of the domain voxels are empty; below z = 0 there is
// rock. Needs READ_U(words) (particles/held.glsl), k.walls, particles/voxel.glsl and particles/bits.glsl.
#include "particles/sides.glsl"

bool voxel_empty(ivec3 v)
{
    if (v.z < 0)
        return false;
    v = side_voxel(v);
    return !voxel_inside(v) || (LOAD_U(words, HELD_STRIDE * voxel_word(v) + 2u) & voxel_bit(v)) == 0u;
}
