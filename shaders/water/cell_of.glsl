// Coordinates of a cell from its number. Quotients below 2^16 by multiplication with reciprocals, corrected by
// at most one: many times faster on devices without integer division. Needs k.per_row and k.per_slab.

uint quotient(uint a, uint b, float per_b)
{
    uint q = uint(float(a) * per_b);
    int rest = int(a) - int(q * b);
    return rest < 0 ? q - 1u : uint(rest) >= b ? q + 1u : q;
}

uvec3 cell_of(uint i)
{
    uint z = quotient(i, k.cx * k.cy, k.per_slab), column = i - z * k.cx * k.cy, y = quotient(column, k.cx, k.per_row);
    return uvec3(column - y * k.cx, y, z);
}
