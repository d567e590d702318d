// Is there no particle in a voxel? Outside the domain there is none; below the ground is more rock. Needs
// READ_U(occupied), a bit for each voxel, particles/voxel.glsl and particles/bits.glsl.

bool voxel_empty(ivec3 v)
{
    if (v.z < 0)
        return false;
    return !voxel_inside(v) || (LOAD_U(occupied, voxel_word(v)) & voxel_bit(v)) == 0u;
}
