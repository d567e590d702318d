// What is counted of viability: quanta of 2^-31, whole numbers, whose sums are the same in any order.

#define QUANTA 2147483648.0

uint quanta(float viability)
{
    return uint(clamp(viability, 0.0, 1.0) * QUANTA);
}

// A sum of two words, the low one first, plus or minus a word.
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
