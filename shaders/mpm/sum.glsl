// Particles to grid, second half: sum of the parts around a node for one of its entries. Needs READ_U of slot,
// many and reach, READ_V(partial).

vec4 entry_sum(uint entry, uint node)
{
    int row = int(k.cx) + 3, slab = row * (int(k.cy) + 3);
    vec4 sum = vec4(0.0);
    for (int z = 0; z < 3; z++)
        for (int y = 0; y < 3; y++)
            for (int x = 0; x < 3; x++) {
                int c = int(node) - z * slab - y * row - x;
                uint first = uint(z * 9 + y * 3 + x) * k.n_parts, s = c >= 0 ? LOAD_U(slot, c) : 0u;
                if (k.bodies == 0u) {
                    if (s != 0u)
                        sum += LOAD_V(partial, first + s - 1u);
                    s = 0u;
                }
                uint end = s != 0u ? s + LOAD_U(many, c) : s;
                for (; s < end; s++)
                    if (LOAD_U(reach, first + s - 1u) == entry)
                        sum += LOAD_V(partial, first + s - 1u);
            }
    return sum;
}
