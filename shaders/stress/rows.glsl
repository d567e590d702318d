// The rows around a node or cell of the grid of k.cx by k.cy by k.cz cells. Needs READ_U(table) and stress/grid.glsl.

#define CELLS uvec3(k.cx, k.cy, k.cz)

// The cell that is seen at c: behind a wall lies the mirror image. Cells more than one beyond are not asked for.
ivec3 side_cell(ivec3 c)
{
    ivec3 low = ivec3((k.walls & WALL_X_MIN) != 0u ? 1 : 0, (k.walls & WALL_Y_MIN) != 0u ? 1 : 0, 0);
    ivec3 high = ivec3(CELLS) - 1 - ivec3((k.walls & WALL_X_MAX) != 0u ? 1 : 0, (k.walls & WALL_Y_MAX) != 0u ? 1 : 0, 0);
    return clamp(c, low, high);
}

// Where the neighbour in the row y, z away is, of what is kept at `at` in the run `own`.
uint row_at(uint own, uint at, int y, int z)
{
    uvec2 next = run_steps(CELLS);
    return y == 0 && z == 0 ? at : LOAD_U(table, own + uint(y) * next.x + uint(z) * next.y) + at % STRESS_RUN;
}
