// Potential flow on the box's cells for the initial air: the uniform wind made divergence-free by the gradient
// of a potential. Needs READ_U(kinds), the cells' kinds, and PARAMS(flow_params).

ivec3 potential_cell(uint i)
{
    return ivec3(i % k.bx, i / k.bx % k.by, i / (k.bx * k.by));
}

uint potential_index(ivec3 c)
{
    return (uint(c.z) * k.by + uint(c.y)) * k.bx + uint(c.x);
}

// x: the wind through the face between cell c and the next one on an axis. y: 1 where the potential may change it: not at
// rock and ground, which nothing passes, and not at the sides, where the air moves with the wind.
vec2 potential_face(ivec3 c, int axis)
{
    ivec3 next = c;
    next[axis]++;
    if (c.z < 0)
        return vec2(0.0);
    uint a = LOAD_U(kinds, potential_index(c)), b = LOAD_U(kinds, potential_index(next));
    if (a == uint(FLOW_ROCK) || b == uint(FLOW_ROCK))
        return vec2(0.0);
    return vec2(vec3(k.wind_x, k.wind_y, 0.0)[axis], a == uint(FLOW_AIR) && b == uint(FLOW_AIR) ? 1.0 : 0.0);
}
