// Samples of the field: k.fx by k.fy by k.fz, stored by bricks of 8^3 (numbered as in particles/grids.h). Item
// i of the buffers is sample i % 512 of brick list[i / 512].

const uint BRICK_SAMPLES = 512u;

uvec3 bricks_across()
{
    return (uvec3(k.fx, k.fy, k.fz) + 7u) >> 3;
}

ivec3 brick_first(uint brick)
{
    uvec3 n = bricks_across();
    return ivec3(uvec3(brick % n.x, brick / n.x % n.y, brick / (n.x * n.y)) << 3);
}

// Coordinates of sample s of a brick; they may be beyond the lattice.
ivec3 brick_sample(uint brick, uint s)
{
    return brick_first(brick) + ivec3(s & 7u, (s >> 3) & 7u, s >> 6);
}

bool lattice_beyond(ivec3 c)
{
    return any(lessThan(c, ivec3(0))) || any(greaterThanEqual(c, ivec3(k.fx, k.fy, k.fz)));
}

uint brick_of(ivec3 c)
{
    uvec3 n = bricks_across(), b = uvec3(c) >> 3;
    return (b.z * n.y + b.y) * n.x + b.x;
}

// Whether the brick with this slot has samples. Others are all outside or all inside.
bool slot_kept(uint slot)
{
    return slot != 0u && slot != SLOT_INSIDE;
}

// Value of samples that are not kept.
float slot_share(uint slot)
{
    return slot == 0u ? 0.0 : 1.0;
}
float slot_distance(uint slot, float voxel)
{
    return slot == 0u ? 3.0 * voxel : -3.0 * voxel;
}

// Index of a sample in the buffers, by the slot of its brick.
uint slot_sample(uint slot, ivec3 c)
{
    return (slot - 1u) * BRICK_SAMPLES + uint(((c.z & 7) << 6) | ((c.y & 7) << 3) | (c.x & 7));
}
