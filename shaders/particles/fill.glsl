// How much of a voxel is rock. Needs READ_U(words), READ_F(fill), particles/voxel.glsl and particles/held.glsl.

float fill_at(ivec3 v)
{
    uint s = voxel_inside(v) ? voxel_slot(v) : NOT_HELD;
    return s == NOT_HELD ? 0.0 : LOAD_F(fill, s);
}
