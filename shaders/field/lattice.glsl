// The field's samples, numbered (k fy + j) fx + i. Needs k.fx, k.fy, k.fz.

uint lattice_index(ivec3 c)
{
    return (uint(c.z) * k.fy + uint(c.y)) * k.fx + uint(c.x);
}

ivec3 lattice_of(uint i)
{
    return ivec3(i % k.fx, (i / k.fx) % k.fy, i / (k.fx * k.fy));
}
