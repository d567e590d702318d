// The place of a cell. Quotients of less than 2^16 by reciprocals, which devices without integer division do
// many times faster; at most one off, and put right. Needs k.per_row and k.per_slab.

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
