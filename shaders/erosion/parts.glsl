// What processes have in an intensity, packed in a word: the shares of deflation and of water, 15 bits each; the rest is
// abrasion's. PARTS_LOOSE alone: water's, of a deposit. With PARTS_SHEETS the first share is that of sheets that come off, and what
// wind plucks meanwhile is in the rest.

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
