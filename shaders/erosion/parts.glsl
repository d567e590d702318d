// The processes' shares in an intensity, packed in a word: deflation's and water's in 15 bits each; the
// remainder is abrasion's. PARTS_LOOSE alone: all is water's, on a deposit. PARTS_SHEETS: the first share is
// that of sheeting and not deflation's, which is in the remainder.

const uint PARTS_LOOSE = 1u << 31, PARTS_SHEETS = 1u << 30;
const float PARTS_WHOLE = 32767.0;

uint parts_of(float deflation, float water)
{
    uint first = uint(round(clamp(deflation, 0.0, 1.0) * PARTS_WHOLE));
    return first | min(uint(round(clamp(water, 0.0, 1.0) * PARTS_WHOLE)), 32767u - first) << 15;
}

// The shares of deflation and of water.
vec2 shares_in(uint parts)
{
    return vec2(parts & 32767u, (parts >> 15) & 32767u) / PARTS_WHOLE;
}
