// Where plants can stand: ground that is not too steep, under the open sky. Needs particles/voxel.glsl and
// particles/empty.glsl.

bool stands(vec3 x, vec3 n)
{
    if (n.z < k.steepest || n == vec3(0.0))
        return false;
    ivec3 v = voxel_of(x);
    for (v.z++; v.z < int(k.nz); v.z++)
        if (!voxel_empty(v))
            return false;
    return true;
}
