#version 460
#extension GL_GOOGLE_include_directive : require
// The rock's share of space at each sample of the field, which are the voxels' middles and a margin of air
// around the domain.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, fill)
WRITE_F(1, share)
PARAMS(field_params)
#include "field/lattice.glsl"
#include "particles/voxel.glsl"

float fill_at(ivec3 v)
{
    return voxel_inside(v) ? LOAD_F(fill, voxel_index(v)) : 0.0;
}
#include "particles/share.glsl"

void main()
{
    uint i = THREAD;
    if (i < k.n)
        AT(share, i) = share_at(lattice_of(i) - int(k.margin));
}
