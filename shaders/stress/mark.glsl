// Marks the runs to be kept for a filled cell: those its nodes are in or next to. Needs WRITE_U(mark) and stress/grid.glsl.

// The first and last of them in the cell's own row.
uvec2 runs_with(ivec3 c, uvec3 cells)
{
    return uvec2(run_of(c - ivec3(1, 0, 0), cells), run_of(c + ivec3(2, 0, 0), cells));
}

// In the rows of its nodes.
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
