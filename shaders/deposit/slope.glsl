// Slope of the ground in a cell, from the mean heights of its four columns and of twelve columns on each side,
// centred 2.5 voxels away. Two measures, since each fails where the other holds:
//
//   flank   the central gradient, which the cell's own roughness does not blur; limited to the angle of repose. Where a
//           wall stands uphill, only the downhill side counts.
//   tip     the upwind gradient: root of the squares of the larger downhill difference along x and y. On the tip of a heap
//           or on a crest the flank is flat and spikes would grow; and this is what one more fragment in the cell changes.
//           A sum of differences instead of the root would turn cones into diamonds.

const float SLOPE_ARM = 2.5;                // voxels between the means
const float SLOPE_GRAIN = 0.25 / SLOPE_ARM; // increase of the tip slope by one more particle
const float SLOPE_TIP = 1.15;               // tips may be steeper by this factor; an ideal cone's is by 1.41

// The free voxel on top of the highest column of the cell with this base.
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

struct slope {
    vec2 tip;    // the larger drop along x and y, as a tangent; below 0 where both sides are uphill
    float flank; // tangent
};

// Drop along an axis, from the drops to its two sides.
float across(float a, float b)
{
    float down = max(a, b), up = -min(a, b);
    return up > 2.0 * k.repose + 0.5 ? max(down, 0.0) : 0.5 * (down + up);
}

slope slope_of(ivec3 base, int top)
{
    float own = block(base, ivec2(2, 2), top);
    vec4 d = (own - vec4(block(base + ivec3(2, -1, 0), ivec2(3, 4), top), block(base + ivec3(-3, -1, 0), ivec2(3, 4), top),
                         block(base + ivec3(-1, 2, 0), ivec2(4, 3), top), block(base + ivec3(-1, -3, 0), ivec2(4, 3), top))) /
             SLOPE_ARM;
    return slope(vec2(max(d.x, d.y), max(d.z, d.w)), length(vec2(across(d.x, d.y), across(d.z, d.w))));
}

// Whether the ground is stable with `more` additional particles in the cell.
bool stable(slope s, float more, float tan_repose)
{
    return s.flank <= tan_repose && length(max(s.tip + more * SLOPE_GRAIN, 0.0)) <= SLOPE_TIP * tan_repose;
}

// How much lower the ground is in the cells to the east, west, north and south, summed over four columns, in voxels; 0 where it
// is not.
uvec4 drops(ivec3 base, int top)
{
    int own = heights(base, ivec2(2, 2), top);
    return uvec4(max(own - ivec4(heights(base + ivec3(2, 0, 0), ivec2(2, 2), top),
                                 heights(base - ivec3(2, 0, 0), ivec2(2, 2), top),
                                 heights(base + ivec3(0, 2, 0), ivec2(2, 2), top),
                                 heights(base - ivec3(0, 2, 0), ivec2(2, 2), top)), 0));
}
