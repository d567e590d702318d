// The sum of REDUCE_THREADS partial sums, by one group of 64 in a fixed tree. Valid in invocation 0.

shared float leaf[64];

float total()
{
    uint i = gl_LocalInvocationID.x;
    float sum = 0.0;
    for (uint j = i; j < REDUCE_THREADS; j += 64u)
        sum += LOAD_F(partial, j);
    leaf[i] = sum;
    for (uint stride = 32u; stride > 0u; stride /= 2u) {
        barrier();
        if (i < stride)
            leaf[i] += leaf[i + stride];
    }
    return leaf[0];
}
