#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: 1 if it is at the surface, with an empty voxel at one of its voxel's faces (Arenite 5.1). Below
// z = 0 is not empty.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
READ_U(1, words)
WRITE_U(2, exposed)
PARAMS(voxel_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/empty.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 v = voxel_of(LOAD_V(position, i).xyz);
    bool bare = voxel_empty(v + ivec3(1, 0, 0)) || voxel_empty(v - ivec3(1, 0, 0)) || voxel_empty(v + ivec3(0, 1, 0)) ||
                voxel_empty(v - ivec3(0, 1, 0)) || voxel_empty(v + ivec3(0, 0, 1)) || voxel_empty(v - ivec3(0, 0, 1));
    AT(exposed, i) = bare ? 1u : 0u;
}
