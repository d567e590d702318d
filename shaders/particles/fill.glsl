// Fill of a voxel. With GROUND_CONTINUES, columns continue below z = 0 as in their lowest voxel. Needs
// READ_U(words), READ_F(fill), k.walls, particles/voxel.glsl and particles/held.glsl.
#include "particles/sides.glsl"

float fill_at(ivec3 v)
{
#ifdef GROUND_CONTINUES
    v.z = max(v.z, 0);
#endif
    v = side_voxel(v);
    if (!voxel_inside(v))
        return 0.0;
    uint s = voxel_slot(v);
    return s != NOT_HELD ? LOAD_F(fill, s) : voxel_deep(v) ? 1.0 : 0.0;
}
