// Cells and nodes of the stress grid, with a margin of one empty cell around, so that no neighbour needs a
// test. Cell (i, j, k) has the nodes (i..i+1, j..j+1, k..k+1); the domain's own begin at 1. Needs k.cx, k.cy,
// k.cz.

uint cell_index(ivec3 c)
{
    return (uint(c.z) * k.cy + uint(c.y)) * k.cx + uint(c.x);
}

uint node_index(ivec3 a)
{
    return (uint(a.z) * (k.cy + 1u) + uint(a.y)) * (k.cx + 1u) + uint(a.x);
}

ivec3 node_of(uint i)
{
    uint nx = k.cx + 1u, ny = k.cy + 1u;
    return ivec3(i % nx, (i / nx) % ny, i / (nx * ny));
}

// How much of the full stiffness a cell has. The floor keeps nearly empty cells from hanging on nothing.
float stiffness(float fill)
{
    return fill > 0.0 ? max(fill, STRESS_FILL_FLOOR) : 0.0;
}
