#include "text/nearest.h"

#include <stdint.h>
#include <string.h>

enum { WORD_MAX = 48 };

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Edit distance with insertions, deletions, replacements and swaps of adjacent characters (optimal string alignment). */
static size_t distance(const char *a, const char *b)
{
    size_t row[3][WORD_MAX + 1], n = strlen(a), m = strlen(b);
    if (n > WORD_MAX || m > WORD_MAX)
        return SIZE_MAX;
    for (size_t j = 0; j <= m; j++)
        row[0][j] = j;
    for (size_t i = 1; i <= n; i++) {
        const size_t *above = row[(i - 1) % 3], *twice = row[(i + 1) % 3];
        size_t *now = row[i % 3];
        now[0] = i;
        for (size_t j = 1; j <= m; j++) {
            now[j] = least(above[j - 1] + (a[i - 1] != b[j - 1]), least(above[j], now[j - 1]) + 1);
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                now[j] = least(now[j], twice[j - 2] + 1);
        }
    }
    return row[n % 3][m];
}

const char *nearest_word(const char *word, const char *const *known, size_t n)
{
    const char *best = NULL;
    size_t length = strlen(word), best_distance = SIZE_MAX;
    for (size_t i = 0; i < n; i++) {
        size_t d = distance(word, known[i]);
        /* An abbreviation counts as one edit: size for size_m, insp for inspect. */
        if (length >= 2 && strncmp(word, known[i], length) == 0)
            d = 1;
        if (d < best_distance) {
            best_distance = d;
            best = known[i];
        }
    }
    return best && best_distance <= 1 + least(length, strlen(best)) / 4 ? best : NULL;
}
