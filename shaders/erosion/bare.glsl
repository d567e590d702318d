// The area of surface that a voxel's bare faces stand for, in units of h^2: the sum of |n_axis| over faces next
// to an empty voxel. Needs voxel_empty().
float bare_area(ivec3 v, vec3 n)
{
    return dot(abs(n), vec3(float(voxel_empty(v + ivec3(1, 0, 0))) + float(voxel_empty(v - ivec3(1, 0, 0))),
                            float(voxel_empty(v + ivec3(0, 1, 0))) + float(voxel_empty(v - ivec3(0, 1, 0))),
                            float(voxel_empty(v + ivec3(0, 0, 1))) + float(voxel_empty(v - ivec3(0, 0, 1)))));
}
