// Boundary of the domain. Beyond an open side there is no rock; beyond a wall there is the mirror image, so
// lookups across a wall read the voxel on this side. Needs k.walls and particles/bits.glsl.

// The voxel to read for v: beyond a wall the mirror image, else v itself.
ivec3 side_voxel(ivec3 v)
{
    if (k.walls == 0u)
        return v;
    ivec2 n = ivec2(HELD_NX, HELD_NY);
    if (v.x < 0 && (k.walls & WALL_X_MIN) != 0u)
        v.x = -1 - v.x;
    if (v.x >= n.x && (k.walls & WALL_X_MAX) != 0u)
        v.x = 2 * n.x - 1 - v.x;
    if (v.y < 0 && (k.walls & WALL_Y_MIN) != 0u)
        v.y = -1 - v.y;
    if (v.y >= n.y && (k.walls & WALL_Y_MAX) != 0u)
        v.y = 2 * n.y - 1 - v.y;
    return v;
}

// Position in voxels of image i of a point in the walls: 0 is the point itself, 1 and 2 are beyond the walls across x, 3 and 6 across
// y, the others beyond one of each. `flip` multiplies directions as the image does. Returns false if there is no such wall.
const int SIDE_IMAGES = 9;

bool side_image(int image, inout vec2 at, out vec3 flip)
{
    int across_x = image % 3, across_y = image / 3;
    flip = vec3(1.0);
    if (image == 0)
        return true;
    if (across_x != 0) {
        if ((k.walls & (across_x == 1 ? WALL_X_MIN : WALL_X_MAX)) == 0u)
            return false;
        at.x = (across_x == 1 ? 0.0 : 2.0 * float(HELD_NX)) - at.x;
        flip.x = -1.0;
    }
    if (across_y != 0) {
        if ((k.walls & (across_y == 1 ? WALL_Y_MIN : WALL_Y_MAX)) == 0u)
            return false;
        at.y = (across_y == 1 ? 0.0 : 2.0 * float(HELD_NY)) - at.y;
        flip.y = -1.0;
    }
    return true;
}
