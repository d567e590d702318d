#version 460
#extension GL_GOOGLE_include_directive : require
// Per lane: adds the viability of every BUDGET_LANES-th particle to a row of the budget, or subtracts it.
// Subtracted before a process and added after it, this is the process's change.
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
