// Voxels as water's cells. Needs particles/voxel.glsl, water/columns.glsl, and k.

#include "particles/bits.glsl"
#include "particles/sides.glsl"

bool voxel_empty(ivec3 v)
{
    v = side_voxel(v);
    return v.z >= 0 && (!voxel_inside(v) || !is_occupied(uint(v.y) * k.nx + uint(v.x), uint(v.z)));
}

// The span whose floor a voxel is; NONE if there is rock above it, or none in it.
uint floor_at(ivec3 v)
{
    uint column = uint(v.y) * k.nx + uint(v.x), word = column * k.words + (uint(v.z) >> 5u);
    return (LOAD_U(floors, word) >> (uint(v.z) & 31u) & 1u) != 0u ? node_at(column, uint(v.z)) : NONE;
}
