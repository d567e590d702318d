#version 460
#extension GL_GOOGLE_include_directive : require
// Per cell of the box: average = keep * average + gain * block of samples. In cells within two of the rock's
// surface, the squared distance between the block's mean velocity and the average, and the squared average, for
// the error estimate.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, surface)
READ_V(1, block)
WRITE_V(2, sums)
WRITE_F(3, apart)
WRITE_F(4, size)
PARAMS(flow_params)
#include "wind/mean.glsl"

bool near_surface(ivec3 c)
{
    ivec3 low = max(c - 2, ivec3(0)), high = min(c + 2, ivec3(k.bx, k.by, k.bz) - 1);
    for (int z = low.z; z <= high.z; z++)
        for (int y = low.y; y <= high.y; y++)
            for (int x = low.x; x <= high.x; x++)
                if (LOAD_U(surface, (uint(z) * k.by + uint(y)) * k.bx + uint(x)) != 0u)
                    return true;
    return false;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    vec4 last = LOAD_V(block, i), sum = k.keep * AT(sums, i) + k.gain * last;
    AT(sums, i) = sum;
    vec3 mean = flow_mean(sum).xyz, d = flow_mean(k.warm * last).xyz - mean;
    bool counts = near_surface(ivec3(i % k.bx, i / k.bx % k.by, i / (k.bx * k.by)));
    AT(apart, i) = counts ? dot(d, d) : 0.0;
    AT(size, i) = counts ? dot(mean, mean) : 0.0;
}
