// Is there rock at a point of the box? Needs READ_U(voxel_start) and PARAMS(flow_params).
#include "particles/voxel.glsl"

bool flow_in_rock(vec3 x)
{
    ivec3 v = ivec3(floor((x * k.spacing + vec3(k.origin_x, k.origin_y, 0.0)) / k.h));
    if (!voxel_inside(v))
        return v.z < 0;
    uint c = voxel_index(v);
    return LOAD_U(voxel_start, c) != LOAD_U(voxel_start, c + 1u);
}
