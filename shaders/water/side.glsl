// The domain's open sides, through which water leaves. Needs k.

// Whether a cell is at an open side: first and last in x, first and last in y.
bvec4 open_sides(uvec3 c)
{
    return bvec4(c.x == 0u && (k.walls & WALL_X_MIN) == 0u, c.x + 1u == k.cx && (k.walls & WALL_X_MAX) == 0u,
                 c.y == 0u && (k.walls & WALL_Y_MIN) == 0u, c.y + 1u == k.cy && (k.walls & WALL_Y_MAX) == 0u);
}

bool is_side(uvec3 c)
{
    return any(open_sides(c));
}
