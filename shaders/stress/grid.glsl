// Cells and nodes of a stress grid, with a margin of one empty cell around, so that no neighbour needs a test. Cell
// (i, j, k) has the nodes (i..i+1, j..j+1, k..k+1), and is kept where its first node is; the domain's own begin at 1.
//
// They are kept in runs of STRESS_RUN along x, ordered as on the whole grid, and of a run's neighbours in its row those
// are kept, too, that a filled cell's node is in or next to (mark.glsl). So a run whose row goes on is followed by what
// follows it on the grid, and a run whose row ends there begins or ends with zeros: whatever is looked up, its neighbours
// in the row are right behind it and right before it. Runs that are not kept are looked up in one that is empty.

// From a run to the next row's, and to the next layer's, in the table of all runs. `cells` are the grid's, with the margin.
uvec2 run_steps(uvec3 cells)
{
    uint row = cells.x / STRESS_RUN + 1u;
    return uvec2(row, row * (cells.y + 1u));
}

uint run_of(ivec3 a, uvec3 cells)
{
    uvec2 next = run_steps(cells);
    return uint(a.z) * next.y + uint(a.y) * next.x + uint(a.x) / STRESS_RUN;
}

// The node that is kept at `at`, in that run.
ivec3 node_of(uint run, uint at, uvec3 cells)
{
    uvec2 next = run_steps(cells);
    return ivec3(run % next.x * STRESS_RUN + at % STRESS_RUN, run % next.y / next.x, run / next.y);
}

// A wall lets its nodes slide along it, and holds them on it: what is left there of a force or a displacement at node a.
// On coarser levels the last node may lie beyond the wall, as the last cell does.
vec3 along_walls(vec3 f, ivec3 a, ivec3 cells, uint walls)
{
    if (((walls & WALL_X_MIN) != 0u && a.x <= 1) || ((walls & WALL_X_MAX) != 0u && a.x >= cells.x - 1))
        f.x = 0.0;
    if (((walls & WALL_Y_MIN) != 0u && a.y <= 1) || ((walls & WALL_Y_MAX) != 0u && a.y >= cells.y - 1))
        f.y = 0.0;
    return f;
}

// How much of the full stiffness a cell has: by its fill, or, where there are deposits in it, as it says itself, negative. The
// floor keeps nearly empty cells from hanging on nothing.
float stiffness(float fill)
{
    return fill > 0.0 ? max(fill, STRESS_FILL_FLOOR) : abs(fill);
}
