// SPH kernel, cells and kinds of the air's particles. Needs PARAMS(flow_params).

// Cubic spline with support FLOW_SUPPORT; its integral is 1. q = r / support.
float flow_kernel(float r)
{
    float q = r / FLOW_SUPPORT, p = max(1.0 - q, 0.0);
    return (1.0 / 3.14159265) * (q <= 0.5 ? 6.0 * (q * q * q - q * q) + 1.0 : 2.0 * p * p * p);
}

// Gradient of the kernel at the offset d of length r.
vec3 flow_slope(vec3 d, float r)
{
    float q = r / FLOW_SUPPORT, p = max(1.0 - q, 0.0);
    return d * ((1.0 / 3.14159265) * (q <= 0.5 ? 4.5 * q - 3.0 : -3.0 * p * p / r));
}

// The cells start half a support below the ground, to hold the ground's boundary particles.
ivec3 flow_cell(vec3 x)
{
    ivec3 c = ivec3(floor(vec3(x.xy, x.z + 0.5 * FLOW_SUPPORT) / FLOW_SUPPORT));
    return clamp(c, ivec3(0), ivec3(k.gx, k.gy, k.gz) - 1);
}

uint flow_index(ivec3 c)
{
    return (uint(c.z) * k.gy + uint(c.y)) * k.gx + uint(c.x);
}

uint flow_dead()
{
    return k.gx * k.gy * k.gz;
}

float flow_kind(vec3 x)
{
    vec3 box = vec3(k.bx, k.by, k.bz);
    bool inner = all(greaterThanEqual(x.xy, vec2(FLOW_SUPPORT))) && all(lessThan(x, box - FLOW_SUPPORT));
    return inner ? FLOW_AIR : FLOW_SKIN;
}

bool flow_inside(vec3 x)
{
    return all(greaterThanEqual(x, vec3(0.0))) && all(lessThan(x, vec3(k.bx, k.by, k.bz)));
}

// Index of the neighbour s of particle i in the lists, which are interleaved in groups of 32 particles.
uint flow_listed(uint i, uint s)
{
    return (i / 32u * FLOW_NEIGHBOURS + s) * 32u + i % 32u;
}
