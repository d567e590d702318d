// Marks the runs to keep for a filled cell: those that hold its nodes or the nodes next to these in the same
// row. Needs WRITE_U(mark) and stress/grid.glsl.

// The first and last of these runs in the cell's own row.
uvec2 runs_with(ivec3 c, uvec3 cells)
{
    return uvec2(run_of(c - ivec3(1, 0, 0), cells), run_of(c + ivec3(2, 0, 0), cells));
}

// Marks them in all four rows of the cell's nodes.
void mark_runs(uvec2 runs, uvec3 cells)
{
    uvec2 next = run_steps(cells);
    for (uint run = runs.x; run <= runs.y; run++) {
        atomicOr(AT(mark, run), 1u);
        atomicOr(AT(mark, run + next.x), 1u);
        atomicOr(AT(mark, run + next.y), 1u);
        atomicOr(AT(mark, run + next.x + next.y), 1u);
    }
}
