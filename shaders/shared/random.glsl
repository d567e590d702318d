// Random numbers as hashes; the same bits as base/random.h.

uint random_hash(uint a, uint b, uint c, uint d)
{
    uvec4 v = uvec4(a, b, c, d) * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v.w;
}

// Uniform in [0, 1).
float random_float(uint hash)
{
    return float(hash >> 8u) * (1.0 / 16777216.0);
}

// Uniform in 0 .. n - 1.
uint random_below(uint hash, uint n)
{
    uint high, low;
    umulExtended(hash, n, high, low);
    return high;
}
