// Does a block that stands on the ground hold a particle of this voxel? It, or a voxel across a face of it, must
// belong to one. Needs READ_U(solid), READ_U(root), particles/voxel.glsl.

bool stands(ivec3 v)
{
    if (!voxel_inside(v))
        return false;
    uint i = voxel_index(v);
    return LOAD_U(solid, i) != 0u && LOAD_U(root, i) < k.nx * k.ny;
}

bool held(ivec3 v)
{
    return stands(v) || stands(v - ivec3(0, 0, 1)) || stands(v + ivec3(0, 0, 1)) || stands(v - ivec3(1, 0, 0)) ||
           stands(v + ivec3(1, 0, 0)) || stands(v - ivec3(0, 1, 0)) || stands(v + ivec3(0, 1, 0));
}
