// Is there no rock in a voxel? Outside the domain there is none; below the ground there is. Needs
// READ_U(start) and particles/voxel.glsl.

bool voxel_empty(ivec3 v)
{
    if (v.z < 0)
        return false;
    if (!voxel_inside(v))
        return true;
    uint c = voxel_index(v);
    return LOAD_U(start, c) == LOAD_U(start, c + 1u);
}
