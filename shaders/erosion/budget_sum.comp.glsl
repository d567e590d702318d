#version 460
#extension GL_GOOGLE_include_directive : require
// Adds all viability to a row of the budget, or takes it off: before and after a process, this makes what it
// changed. Each invocation has a sum of its own, over every BUDGET_LANES-th value.
#include "shared/buffers.glsl"
#include "shared/params.h"
#include "erosion/budget.glsl"

READ_F(0, viability)
WRITE_U(1, sums)
PARAMS(budget_params)

void main()
{
    uint lane = THREAD, at = 2u * (k.row * BUDGET_LANES + lane);
    if (lane >= k.n)
        return;
    uvec2 sum = uvec2(AT(sums, at), AT(sums, at + 1u));
    for (uint i = lane; i < k.n_values; i += BUDGET_LANES) {
        uint value = quanta(LOAD_F(viability, i));
        sum = k.after != 0u ? plus(sum, value) : minus(sum, value);
    }
    AT(sums, at) = sum.x;
    AT(sums, at + 1u) = sum.y;
}
