#version 460
#extension GL_GOOGLE_include_directive : require
// Per lane: books what erosion removed from each particle (`spent`, quanta) to the processes by their share in
// the intensity (`parts`). Abrasion gets the remainder, so that the rows add up exactly. What water removed
// from deposits is booked to a row of its own.
#include "shared/buffers.glsl"
#include "shared/params.h"
#include "erosion/budget.glsl"
#include "erosion/parts.glsl"

READ_U(0, spent)
READ_U(1, parts)
WRITE_U(2, sums)
PARAMS(budget_split_params)

uint share_of(uint whole, float share)
{
    return share >= 1.0 ? whole : min(uint(share * float(whole)), whole);
}

void take(uint row, uint lane, uvec2 sum)
{
    uint at = 2u * (row * BUDGET_LANES + lane);
    uint borrow, low = usubBorrow(AT(sums, at), sum.x, borrow);
    AT(sums, at) = low;
    AT(sums, at + 1u) -= sum.y + borrow;
}

void main()
{
    uint lane = THREAD;
    if (lane >= k.n)
        return;
    uvec2 deflation = uvec2(0u), sheets = uvec2(0u), water = uvec2(0u), abrasion = uvec2(0u), reworking = uvec2(0u);
    for (uint i = lane; i < k.n_values; i += BUDGET_LANES) {
        uint whole = LOAD_U(spent, i);
        if (whole == 0u)
            continue;
        if (whole > uint(QUANTA)) { // negative: rounding in erosion/carry left more than there was before
            abrasion = minus(abrasion, 0u - whole);
            continue;
        }
        vec2 share = shares_in(LOAD_U(parts, i));
        if ((LOAD_U(parts, i) & PARTS_LOOSE) != 0u) {
            reworking = plus(reworking, whole);
            continue;
        }
        uint first = share_of(whole, share.x), rest = whole - first;
        uint second = share.x + share.y >= 0.99999 ? rest : min(share_of(whole, share.y), rest);
        if ((LOAD_U(parts, i) & PARTS_SHEETS) != 0u)
            sheets = plus(sheets, first);
        else
            deflation = plus(deflation, first);
        water = plus(water, second);
        abrasion = plus(abrasion, rest - second);
    }
    take(k.deflation, lane, deflation);
    take(k.water, lane, water);
    take(k.abrasion, lane, abrasion);
    take(k.reworking, lane, reworking);
    take(k.sheets, lane, sheets);
}
