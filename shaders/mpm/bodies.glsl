// The bodies that reach a node, in the order of its cells. Needs READ_U of slot, many and part_body.

uint bodies_at(uint node, out uint bodies[MPM_BODIES])
{
    int row = int(k.cx) + 3, slab = row * (int(k.cy) + 3);
    uint n = 0u;
    for (int b = 0; b < MPM_BODIES; b++)
        bodies[b] = 0u;
    for (int a = 0; a < 27; a++) {
        int c = int(node) - (a / 9) * slab - (a / 3 % 3) * row - a % 3;
        uint s = c >= 0 ? LOAD_U(slot, c) : 0u, end = s != 0u ? s + LOAD_U(many, c) : s;
        for (; s < end; s++) {
            uint body = LOAD_U(part_body, s - 1u);
            bool known = false;
            for (int b = 0; b < MPM_BODIES; b++)
                known = known || (uint(b) < n && bodies[b] == body);
            for (int b = 0; b < MPM_BODIES; b++)
                if (!known && uint(b) == n)
                    bodies[b] = body;
            n += known ? 0u : 1u;
        }
    }
    return min(n, uint(MPM_BODIES));
}
