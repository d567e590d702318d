// The corners of the box of a brick's samples that are not 0, three bits a number, and EXTENT_ANY; 0 where there is nothing.
// The values lie on a grid of their own, k.nx by k.ny by k.nz, whose first is the field's sample k.margin. Needs value_at(), and
// field/lattice.glsl.

uint extent_of(uint brick)
{
    ivec3 first = brick_first(brick), low = ivec3(8), high = ivec3(-1);
    ivec3 from = max(first - int(k.margin), ivec3(0)), to = min(first - int(k.margin) + 7, ivec3(k.nx, k.ny, k.nz) - 1);
    for (int z = from.z; z <= to.z; z++)
        for (int y = from.y; y <= to.y; y++)
            for (int x = from.x; x <= to.x; x++)
                if (value_at(ivec3(x, y, z)) > 0.0) {
                    ivec3 c = ivec3(x, y, z) + int(k.margin) - first;
                    low = min(low, c);
                    high = max(high, c);
                }
    return high.x < 0 ? 0u
                      : EXTENT_ANY | uint(low.x | (low.y << 3) | (low.z << 6) | (high.x << 9) | (high.y << 12) |
                                          (high.z << 15));
}
