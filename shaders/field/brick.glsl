// The field's bricks of 8^3 samples, as particles/grids.h numbers them. Needs k of field_brick_params.

const int BRICK_SIDE = 8;
const uint BRICK_SAMPLES = 512u;

// Sample s of a brick, in samples of the lattice: maybe beyond it.
ivec3 brick_sample(uint brick, uint s)
{
    uvec3 first = uvec3(brick % k.bx, brick / k.bx % k.by, brick / (k.bx * k.by)) * uint(BRICK_SIDE);
    return ivec3(first + uvec3(s & 7u, (s >> 3) & 7u, s >> 6));
}

bool brick_beyond(ivec3 c)
{
    return any(greaterThanEqual(c, ivec3(k.fx, k.fy, k.fz)));
}
