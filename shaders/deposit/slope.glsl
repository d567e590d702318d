// How steep the ground of a cell is, as a tangent: the root of the squares of the larger downhill difference of
// each axis. Means of normals, or central differences, are flat on the tip of a spike, and plain differences
// would make diamonds of cones. Heights are means over the cell's four columns and over the twelve on each side
// of it, two and a half voxels off.

const float SLOPE_ARM = 2.5;                // voxels between the means
const float SLOPE_GRAIN = 0.25 / SLOPE_ARM; // what one more particle adds

// The free voxel over the highest column of the cell with this base.
int cell_top(ivec3 base)
{
    return max(max(floor_in(base.x, base.y, base.z), floor_in(base.x + 1, base.y, base.z)),
               max(floor_in(base.x, base.y + 1, base.z), floor_in(base.x + 1, base.y + 1, base.z)));
}

int heights(ivec3 low, ivec2 size, int z)
{
    int sum = 0;
    for (int y = 0; y < size.y; y++)
        for (int x = 0; x < size.x; x++)
            sum += floor_near(low.x + x, low.y + y, z);
    return sum;
}

float block(ivec3 low, ivec2 size, int z)
{
    return float(heights(low, size, z)) / float(size.x * size.y);
}

// The larger downhill difference along x and y; below 0 where both sides are uphill.
vec2 downhill(ivec3 base, int top)
{
    float own = block(base, ivec2(2, 2), top);
    float east = block(base + ivec3(2, -1, 0), ivec2(3, 4), top), west = block(base + ivec3(-3, -1, 0), ivec2(3, 4), top);
    float north = block(base + ivec3(-1, 2, 0), ivec2(4, 3), top), south = block(base + ivec3(-1, -3, 0), ivec2(4, 3), top);
    return vec2(own - min(east, west), own - min(north, south)) / SLOPE_ARM;
}

// The tangent with `more` particles more in the cell.
float slope_with(vec2 d, float more)
{
    return length(max(d + more * SLOPE_GRAIN, 0.0));
}

// How much lower the ground is in the cells beside this one, east, west, north and south, in voxels of four
// columns; 0 where it is not.
uvec4 drops(ivec3 base, int top)
{
    int own = heights(base, ivec2(2, 2), top);
    return uvec4(max(own - ivec4(heights(base + ivec3(2, 0, 0), ivec2(2, 2), top),
                                 heights(base - ivec3(2, 0, 0), ivec2(2, 2), top),
                                 heights(base + ivec3(0, 2, 0), ivec2(2, 2), top),
                                 heights(base - ivec3(0, 2, 0), ivec2(2, 2), top)), 0));
}
