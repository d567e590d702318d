// The rows around a node or cell of the grid of k.cx by k.cy by k.cz cells. Needs READ_U(table) and stress/grid.glsl.

#define CELLS uvec3(k.cx, k.cy, k.cz)

// Where the neighbour in the row y, z away is, of what is kept at `at` in the run `own`.
uint row_at(uint own, uint at, int y, int z)
{
    uvec2 next = run_steps(CELLS);
    return y == 0 && z == 0 ? at : LOAD_U(table, own + uint(y) * next.x + uint(z) * next.y) + at % STRESS_RUN;
}
