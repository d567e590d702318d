// Cells and nodes of a stress grid. A margin of one empty cell surrounds the domain, so that neighbours need no
// bounds test; the domain's first cell has index 1. Cell (i, j, k) has the nodes (i..i+1, j..j+1, k..k+1) and
// is stored in the slot of its first node.
//
// Slots come in runs of STRESS_RUN along x, in the order of the whole grid. A run is kept if it holds a node of
// a filled cell or a node next to such a node in its row (mark.glsl). So the neighbours x-1 and x+1 of any item
// that is read are in the slots right before and after it: where the next run of the row is kept it follows
// directly, and where it is not the kept run ends in zeros. Lookups of runs that are not kept lead to an empty
// run.

// Steps in the table of runs from a run to that of the next row and of the next layer. `cells` counts the margin.
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

// The node in slot `at`, which belongs to `run`.
ivec3 node_of(uint run, uint at, uvec3 cells)
{
    uvec2 next = run_steps(cells);
    return ivec3(run % next.x * STRESS_RUN + at % STRESS_RUN, run % next.y / next.x, run / next.y);
}

// Boundary condition of walls (free slip): removes the normal component of a force or displacement at node a. On coarser
// levels the last node and cell may lie beyond the wall.
vec3 along_walls(vec3 f, ivec3 a, ivec3 cells, uint walls)
{
    if (((walls & WALL_X_MIN) != 0u && a.x <= 1) || ((walls & WALL_X_MAX) != 0u && a.x >= cells.x - 1))
        f.x = 0.0;
    if (((walls & WALL_Y_MIN) != 0u && a.y <= 1) || ((walls & WALL_Y_MAX) != 0u && a.y >= cells.y - 1))
        f.y = 0.0;
    return f;
}

// A cell's share of the full stiffness: its fill, but at least STRESS_FILL_FLOOR so that K stays well conditioned; or, where
// fill.comp.glsl has stored the share itself as a negative number, that.
float stiffness(float fill)
{
    return fill > 0.0 ? max(fill, STRESS_FILL_FLOOR) : abs(fill);
}
