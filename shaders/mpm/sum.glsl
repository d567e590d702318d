// Particles to grid, second half: what the occupied cells around a node give it. Needs READ_U(slot),
// READ_V(partial).

vec4 node_sum(uint node)
{
    int row = int(k.cx) + 3, slab = row * (int(k.cy) + 3);
    vec4 sum = vec4(0.0);
    for (int z = 0; z < 3; z++)
        for (int y = 0; y < 3; y++)
            for (int x = 0; x < 3; x++) {
                int c = int(node) - z * slab - y * row - x;
                uint s = c >= 0 ? LOAD_U(slot, c) : 0u;
                if (s != 0u)
                    sum += LOAD_V(partial, uint(z * 9 + y * 3 + x) * k.n_cells + s - 1u);
            }
    return sum;
}
