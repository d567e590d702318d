// The lattice of nodes and base cells, and a particle's position in it. Needs mpm_params.

uint mpm_index(ivec3 a)
{
    return (uint(a.z) * (k.cy + 3u) + uint(a.y)) * (k.cx + 3u) + uint(a.x);
}

ivec3 mpm_at(uint i)
{
    uint nx = k.cx + 3u, ny = k.cy + 3u;
    return ivec3(i % nx, (i / nx) % ny, i / (nx * ny));
}

bool mpm_in_domain(vec3 x)
{
    return all(greaterThanEqual(x, vec3(0.0))) && all(lessThan(x, vec3(k.cx, k.cy, k.cz) * k.dx));
}

// Position in cells from node (1, 1, 1).
vec3 mpm_cells(vec3 x)
{
    return x / k.dx + vec3(0.0, 0.0, k.lift);
}

// Position among the particle's 27 nodes, in cells from the first: 1/2 to 3/2 when it was sorted, a little outside after it has
// moved.
vec3 mpm_offset(vec3 x, uint home)
{
    return mpm_cells(x) - vec3(mpm_at(home) - 1);
}

// Quadratic B-spline weights of the three nodes. As polynomials they sum to 1, reproduce linear functions and have variance 1/4
// for every f, so the transfers stay exact when f leaves [1/2, 3/2]. All are positive while |f - 1| < 0.86.
void mpm_weights(vec3 f, out vec3 w0, out vec3 w1, out vec3 w2)
{
    w0 = 0.5 * (1.5 - f) * (1.5 - f);
    w1 = 0.75 - (f - 1.0) * (f - 1.0);
    w2 = 0.5 * (f - 0.5) * (f - 0.5);
}
