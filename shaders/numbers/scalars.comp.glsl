#version 460
#extension GL_GOOGLE_include_directive : require
// Per thread, over every NUMBERS_THREADS-th value: the smallest number of a value that is not finite or exceeds
// its limit.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, value)
WRITE_U(1, found)
PARAMS(numbers_params)

void main()
{
    uint first = 0xffffffffu;
    // Not "> most", which is false for NaN.
    for (uint i = THREAD; i < k.n; i += NUMBERS_THREADS)
        if (!(abs(LOAD_F(value, i)) <= k.most))
            first = min(first, i);
    if (first != 0xffffffffu)
        atomicMin(AT(found, k.slot), first);
}
