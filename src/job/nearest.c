#include <stdio.h>
#include <string.h>

#include "job/parse.h"

enum { LETTERS = 48 };

/* Insertions, deletions, replacements and swaps of neighbours that make b of a (optimal string alignment). */
static size_t edits(const char *a, const char *b)
{
    size_t n = strlen(a), m = strlen(b), row[3][LETTERS + 1];
    if (n > LETTERS || m > LETTERS)
        return LETTERS;
    for (size_t j = 0; j <= m; j++)
        row[0][j] = j;
    for (size_t i = 1; i <= n; i++) {
        size_t *now = row[i % 3], *before = row[(i + 2) % 3], *earlier = row[(i + 1) % 3];
        now[0] = i;
        for (size_t j = 1; j <= m; j++) {
            size_t best = before[j - 1] + (a[i - 1] != b[j - 1]);
            if (before[j] + 1 < best)
                best = before[j] + 1;
            if (now[j - 1] + 1 < best)
                best = now[j - 1] + 1;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && earlier[j - 2] + 1 < best)
                best = earlier[j - 2] + 1;
            now[j] = best;
        }
    }
    return row[n % 3][m];
}

const char *nearest(const char *word, const char *const *names, size_t n, char out[600])
{
    size_t length = strlen(word), best = LETTERS;
    const char *name = NULL;
    for (size_t i = 0; i < n; i++) {
        size_t d = edits(word, names[i]);
        /* size for size_m: the unit was forgotten */
        if (length >= 3 && strncmp(word, names[i], length) == 0 && names[i][length] == '_')
            d = 1;
        if (d < best) {
            best = d;
            name = names[i];
        }
    }
    if (name && best <= 1 + length / 4) {
        snprintf(out, 600, "did you mean %s?", name);
        return out;
    }
    size_t used = (size_t)snprintf(out, 600, "known here:");
    for (size_t i = 0; i < n && used < 500; i++)
        used += (size_t)snprintf(out + used, 600 - used, "%s %.60s", i ? "," : "", names[i]);
    return out;
}
