// Whether a point of the box is in rock. Needs READ_U(words) and PARAMS(flow_params).
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/empty.glsl"

bool flow_in_rock(vec3 x)
{
    ivec3 v = ivec3(floor((x * k.spacing + vec3(k.origin_x, k.origin_y, 0.0)) / k.h));
    return !voxel_empty(v);
}
