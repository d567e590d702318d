// Contact with ground and resting rock: bodies may separate but not enter, with Coulomb friction.

vec3 off_wall(vec3 v, vec3 n)
{
    float into = dot(v, n);
    if (into >= 0.0)
        return v;
    vec3 along = v - into * n;
    float speed = length(along);
    return speed > 0.0 ? along * max(1.0 + k.friction * into / speed, 0.0) : vec3(0.0);
}

// No friction at the domain's walls: beyond them is the mirror image, which moves along.
vec3 off_sides(vec3 v, ivec3 a)
{
    if ((k.walls & WALL_X_MIN) != 0u && a.x <= 1)
        v.x = max(v.x, 0.0);
    if ((k.walls & WALL_X_MAX) != 0u && a.x > int(k.cx))
        v.x = min(v.x, 0.0);
    if ((k.walls & WALL_Y_MIN) != 0u && a.y <= 1)
        v.y = max(v.y, 0.0);
    if ((k.walls & WALL_Y_MAX) != 0u && a.y > int(k.cy))
        v.y = min(v.y, 0.0);
    return v;
}

// `wall`: normal out of resting rock at the node (xyz); 1 in w if the node is inside resting rock.
vec3 off_walls(vec3 v, vec4 wall, uint node)
{
    if (k.rock != 0u && wall.w > 0.0)
        v = off_wall(v, wall.xyz);
    if (mpm_at(node).z <= 1)
        v = off_wall(v, vec3(0.0, 0.0, 1.0));
    return k.walls != 0u ? off_sides(v, mpm_at(node)) : v;
}
