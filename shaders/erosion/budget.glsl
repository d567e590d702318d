// Viability in quanta of 2^-31: integers, whose sums are the same in any order. Sums are two words.

#define QUANTA 2147483648.0

uint quanta(float viability)
{
    return uint(clamp(viability, 0.0, 1.0) * QUANTA);
}

// A sum of two words, low word first, plus or minus one word.
uvec2 plus(uvec2 sum, uint more)
{
    uint carry;
    sum.x = uaddCarry(sum.x, more, carry);
    return uvec2(sum.x, sum.y + carry);
}
uvec2 minus(uvec2 sum, uint less)
{
    uint borrow;
    sum.x = usubBorrow(sum.x, less, borrow);
    return uvec2(sum.x, sum.y - borrow);
}
