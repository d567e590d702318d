// Contact with ground and resting rock, which bodies may leave but not enter and rub along by Coulomb's law.

vec3 off_wall(vec3 v, vec3 n)
{
    float into = dot(v, n);
    if (into >= 0.0)
        return v;
    vec3 along = v - into * n;
    float speed = length(along);
    return speed > 0.0 ? along * max(1.0 + k.friction * into / speed, 0.0) : vec3(0.0);
}

// `wall`: the normal out of resting rock at the node, and whether there is any.
vec3 off_walls(vec3 v, vec4 wall, uint node)
{
    if (k.rock != 0u && wall.w > 0.0)
        v = off_wall(v, wall.xyz);
    if (mpm_at(node).z <= 1)
        v = off_wall(v, vec3(0.0, 0.0, 1.0));
    return v;
}
