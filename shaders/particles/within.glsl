// The particles of a voxel, as a half-open range. start[slot] is a held voxel's first. Needs READ_U(words),
// READ_U(start), and particles/held.glsl.

uvec2 voxel_particles(ivec3 v)
{
    uint s = voxel_slot(v);
    return s == NOT_HELD ? uvec2(0u) : uvec2(LOAD_U(start, s), LOAD_U(start, s + 1u));
}

// The particles of the voxels `low` to `high`, both included, of a row along x.
uvec2 row_particles(int low, int high, int y, int z)
{
    return uvec2(LOAD_U(start, voxel_rank(ivec3(low, y, z))), LOAD_U(start, voxel_rank(ivec3(high + 1, y, z))));
}
