// Routing cells and voxels: 2^3 voxels to a cell, on a shifted grid. Needs voxel.glsl.

ivec3 cell_of(ivec3 v)
{
    return (v + ivec3(k.sx, k.sy, k.sz)) >> 1;
}

uint cell_index(ivec3 c)
{
    return (uint(c.z) * k.cy + uint(c.y)) * k.cx + uint(c.x);
}

ivec3 cell_at(uint c)
{
    return ivec3(c % k.cx, (c / k.cx) % k.cy, c / (k.cx * k.cy));
}

bool cell_inside(ivec3 c)
{
    return all(greaterThanEqual(c, ivec3(0))) && all(lessThan(c, ivec3(k.cx, k.cy, k.cz)));
}

// A cell's lowest voxel; it may be outside the domain.
ivec3 cell_base(ivec3 c)
{
    return 2 * c - ivec3(k.sx, k.sy, k.sz);
}
