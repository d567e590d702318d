// Access to the rows of nodes or cells next to an item, on a grid of k.cx by k.cy by k.cz cells. Needs
// READ_U(table) and stress/grid.glsl.

#define CELLS uvec3(k.cx, k.cy, k.cz)

// The cell to read for c: beyond a wall, the mirror image's. c is at most one cell beyond.
ivec3 side_cell(ivec3 c)
{
    ivec3 low = ivec3((k.walls & WALL_X_MIN) != 0u ? 1 : 0, (k.walls & WALL_Y_MIN) != 0u ? 1 : 0, 0);
    ivec3 high = ivec3(CELLS) - 1 - ivec3((k.walls & WALL_X_MAX) != 0u ? 1 : 0, (k.walls & WALL_Y_MAX) != 0u ? 1 : 0, 0);
    return clamp(c, low, high);
}

// Slot of the neighbour (0, y, z) of the item in slot `at`, which belongs to run `own`.
uint row_at(uint own, uint at, int y, int z)
{
    uvec2 next = run_steps(CELLS);
    return y == 0 && z == 0 ? at : LOAD_U(table, own + uint(y) * next.x + uint(z) * next.y) + at % STRESS_RUN;
}
