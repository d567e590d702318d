#include "image/sliding_max.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

enum { COLUMNS = 16 }; /* a cache line of floats */

/* Floats of scratch memory that max_line() needs. */
static size_t scratch_size(size_t n, size_t radius)
{
    return 2 * (n + 4 * radius + 1);
}

static float larger(float a, float b)
{
    return a > b ? a : b;
}

/* line[i] becomes the largest of line[i - radius .. i + radius]. The line is cut into blocks of 2 radius + 1 items; a window spans at
 * most two blocks, so its maximum is that of a running maximum from the begin of one and from the end of the other (van Herk 1992, Gil
 * and Werman 1993). */
static void max_line(float *line, size_t n, size_t radius, float *scratch)
{
    const size_t length = 2 * radius + 1, padded = (n + 2 * radius + length - 1) / length * length;
    float *from_begin = scratch, *from_end = scratch + padded;
    for (size_t i = 0; i < padded; i++)
        from_begin[i] = from_end[i] = i >= radius && i - radius < n ? line[i - radius] : -INFINITY;
    for (size_t block = 0; block < padded; block += length)
        for (size_t k = 1; k < length; k++) {
            const size_t back = block + length - 1 - k;
            from_begin[block + k] = larger(from_begin[block + k], from_begin[block + k - 1]);
            from_end[back] = larger(from_end[back], from_end[back + 1]);
        }
    for (size_t i = 0; i < n; i++)
        line[i] = larger(from_end[i], from_begin[i + 2 * radius]);
}

/* The same for columns, as many at a time as a cache line has floats. They are copied to columns[COLUMNS * (height + COLUMNS)], whose
 * stride is not a power of 2, so that they do not share cache sets. */
static void max_columns(float *field, size_t width, size_t height, size_t radius, float *columns,
                        float *scratch)
{
    const size_t stride = height + COLUMNS;
    for (size_t x = 0; x < width; x += COLUMNS) {
        const size_t n = width - x < COLUMNS ? width - x : COLUMNS;
        for (size_t y = 0; y < height; y++)
            for (size_t k = 0; k < n; k++)
                columns[k * stride + y] = field[y * width + x + k];
        for (size_t k = 0; k < n; k++)
            max_line(columns + k * stride, height, radius, scratch);
        for (size_t y = 0; y < height; y++)
            for (size_t k = 0; k < n; k++)
                field[y * width + x + k] = columns[k * stride + y];
    }
}

status sliding_max(size_t width, size_t height, size_t rx, size_t ry, float *field)
{
    status st = OK;
    const size_t row = scratch_size(width, rx), column = scratch_size(height, ry);
    float *scratch = NULL, *columns = NULL;
    TRY(memory_alloc(row > column ? row : column, sizeof *scratch, "a heightfield", &scratch));
    TRY(memory_alloc(COLUMNS * (height + COLUMNS), sizeof *columns, "a heightfield", &columns));
    for (size_t y = 0; y < height; y++)
        max_line(field + y * width, width, rx, scratch);
    max_columns(field, width, height, ry, columns, scratch);
done:
    free(scratch);
    free(columns);
    return st;
}
