// Checks NUMBERS_ARRAYS arrays. The including kernel declares them as array_0 to array_7 and defines LOAD_ITEM(name, i), and
// FITS(item): whether an item is finite and within k.most; written so that it is false for NaN.
#define CHECK(b, name)                                                                                      \
    {                                                                                                       \
        uint first = 0xffffffffu;                                                                           \
        for (uint i = THREAD; i < k.n[b]; i += NUMBERS_THREADS)                                             \
            if (!FITS(LOAD_ITEM(name, i)))                                                                  \
                first = min(first, i);                                                                      \
        if (first != 0xffffffffu)                                                                           \
            atomicMin(AT(found, k.slot[b]), first);                                                         \
    }

void main()
{
    CHECK(0, array_0)
    CHECK(1, array_1)
    CHECK(2, array_2)
    CHECK(3, array_3)
    CHECK(4, array_4)
    CHECK(5, array_5)
    CHECK(6, array_6)
    CHECK(7, array_7)
}
