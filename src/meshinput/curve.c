#include "meshinput/curve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { DIGIT = 11, CURVE_BITS = 21 };

/* Inserts two zero bits after each of the lowest 21 bits. */
static uint64_t spread_bits(uint64_t x)
{
    x = (x | x << 32) & UINT64_C(0x1f00000000ffff);
    x = (x | x << 16) & UINT64_C(0x1f0000ff0000ff);
    x = (x | x << 8) & UINT64_C(0x100f00f00f00f00f);
    x = (x | x << 4) & UINT64_C(0x10c30c30c30c30c3);
    return (x | x << 2) & UINT64_C(0x1249249249249249);
}

struct item {
    uint64_t key;
    uint32_t triangle;
};

/* Radix sort, least significant digit first. The result is in item[n]; other[n] is scratch. */
static void sort_items(struct item *item, struct item *other, size_t n)
{
    for (int shift = 0; shift < 3 * CURVE_BITS; shift += DIGIT) {
        size_t start[(1 << DIGIT) + 1] = {0};
        for (size_t i = 0; i < n; i++)
            start[(item[i].key >> shift & ((1 << DIGIT) - 1)) + 1]++;
        for (size_t d = 0; d < 1 << DIGIT; d++)
            start[d + 1] += start[d];
        for (size_t i = 0; i < n; i++)
            other[start[item[i].key >> shift & ((1 << DIGIT) - 1)]++] = item[i];
        memcpy(item, other, n * sizeof *item);
    }
}

status curve_order(const double (*vertex)[3], const uint32_t (*triangle)[3], size_t n, const double lo[3],
                   const double hi[3], uint32_t **order)
{
    status st = OK;
    struct item *item = NULL, *other = NULL;
    double size = 0;
    *order = NULL;
    TRY(memory_alloc(n, sizeof *item, "the triangles of a mesh", &item));
    TRY(memory_alloc(n, sizeof *other, "the triangles of a mesh", &other));
    TRY(memory_alloc(n, sizeof **order, "the triangles of a mesh", order));
    for (int a = 0; a < 3; a++)
        size = fmax(size, hi[a] - lo[a]);
    for (size_t t = 0; t < n; t++) {
        item[t].triangle = (uint32_t)t;
        for (int a = 0; a < 3; a++) {
            double x = 0;
            for (int k = 0; k < 3; k++)
                x += vertex[triangle[t][k]][a] / 3;
            const double share = size > 0 ? (x - lo[a]) / size : 0;
            item[t].key |= spread_bits((uint64_t)(fmin(fmax(share, 0), 1) * ((1 << CURVE_BITS) - 1))) << a;
        }
    }
    sort_items(item, other, n);
    for (size_t t = 0; t < n; t++)
        (*order)[t] = item[t].triangle;
done:
    free(item);
    free(other);
    return st;
}
