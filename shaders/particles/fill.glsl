// How much of a voxel is rock; with GROUND_IS_ROCK, below the ground is more of the same. Needs READ_U(words), READ_F(fill),
// particles/voxel.glsl and particles/held.glsl.

float fill_at(ivec3 v)
{
#ifdef GROUND_IS_ROCK
    v.z = max(v.z, 0);
#endif
    uint s = voxel_inside(v) ? voxel_slot(v) : NOT_HELD;
    return s == NOT_HELD ? 0.0 : LOAD_F(fill, s);
}
