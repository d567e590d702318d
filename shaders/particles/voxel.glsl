// The domain's voxels, numbered (k ny + j) nx + i. Needs k.nx, k.ny, k.nz and k.h.

ivec3 voxel_of(vec3 x)
{
    return clamp(ivec3(floor(x / k.h)), ivec3(0), ivec3(k.nx, k.ny, k.nz) - 1);
}

uint voxel_index(ivec3 v)
{
    return (uint(v.z) * k.ny + uint(v.y)) * k.nx + uint(v.x);
}

bool voxel_inside(ivec3 v)
{
    return all(greaterThanEqual(v, ivec3(0))) && all(lessThan(v, ivec3(k.nx, k.ny, k.nz)));
}
