// The voxels of a cell that are inside the domain: [low, high) on each axis.

void cell_voxels(uvec3 c, out uvec3 low, out uvec3 high)
{
    ivec3 from = int(k.size) * ivec3(c) - ivec3(k.sx, k.sy, k.sz);
    low = uvec3(max(from, ivec3(0)));
    high = uvec3(min(from + int(k.size), ivec3(k.vx, k.vy, k.vz)));
}
