#include "heap_ref.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "../../shaders/shared/params.h"

enum { REACH = 3, UNIT = 64 };
static const float NONE = -1e9f;

struct columns {
    const int *n;
    const float *loose;
    float *height, *base; /* of heads; NONE elsewhere */
};

static bool inside(const int n[3], int x, int y, int z)
{
    return x >= 0 && y >= 0 && z >= 0 && x < n[0] && y < n[1] && z < n[2];
}

static size_t at(const int n[3], int x, int y, int z)
{
    return ((size_t)z * (size_t)n[1] + (size_t)y) * (size_t)n[0] + (size_t)x;
}

static float loose_at(const struct columns *c, int x, int y, int z)
{
    return z < 0 ? -1 : inside(c->n, x, y, z) ? c->loose[at(c->n, x, y, z)] : 0;
}

static void begin(struct columns *c)
{
    for (int z = 0; z < c->n[2]; z++)
        for (int y = 0; y < c->n[1]; y++)
            for (int x = 0; x < c->n[0]; x++) {
                const size_t i = at(c->n, x, y, z);
                const float own = c->loose[i], below = loose_at(c, x, y, z - 1);
                c->height[i] = NONE;
                c->base[i] = 0;
                if (own > 0 && loose_at(c, x, y, z + 1) == 0) {
                    int down = 0;
                    while (down < REACH && loose_at(c, x, y, z - down - 1) > 0)
                        down++;
                    c->height[i] = UNIT * ((float)z + own);
                    c->base[i] = (float)(UNIT * (z - down));
                } else if (own == 0 && below < 0) {
                    c->height[i] = c->base[i] = (float)(UNIT * z);
                }
            }
}

/* The head of a column nearest to a voxel, looked for from it up and down in turn; -1: none. */
static long head_near(const struct columns *c, int x, int y, int z)
{
    for (int far = 0; far <= REACH; far++)
        for (int up = 1; up >= (far ? -1 : 1); up -= 2)
            if (inside(c->n, x, y, z + up * far) && c->height[at(c->n, x, y, z + up * far)] > NONE)
                return (long)at(c->n, x, y, z + up * far);
    return -1;
}

static void slide(struct columns *c, double repose, float *after)
{
    for (int z = 0; z < c->n[2]; z++)
        for (int y = 0; y < c->n[1]; y++)
            for (int x = 0; x < c->n[0]; x++) {
                const size_t i = at(c->n, x, y, z);
                double change = 0;
                for (int b = -1; b <= 1 && c->height[i] > NONE; b++)
                    for (int a = -1; a <= 1; a++) {
                        const long j = a || b ? head_near(c, x + a, y + b, z) : -1;
                        if (j < 0)
                            continue;
                        const double drop = (double)c->height[i] - (double)c->height[j],
                                     over = fabs(drop) - round(UNIT * repose * hypot(a, b));
                        const size_t giver = drop > 0 ? i : (size_t)j;
                        if (over > 0)
                            change -=
                                copysign(fmin(fmax(floor(over / 10), over >= 7 ? 1 : 0),
                                              floor(((double)c->height[giver] - (double)c->base[giver]) / 8)),
                                         drop);
                    }
                after[i] = c->height[i] + (float)change;
            }
}

static float deposits_in(const struct columns *c, int x, int y, int z, float own)
{
    for (int far = 0; far <= REACH; far++)
        for (int up = 1; up >= (far ? -1 : 1); up -= 2) {
            const int head = z + up * far;
            if (!inside(c->n, x, y, head) || c->height[at(c->n, x, y, head)] == NONE ||
                (own == 0 && head > z))
                continue;
            const float top = fminf(fmaxf(c->height[at(c->n, x, y, head)] / UNIT - (float)z, 0), 1);
            return head > z ? fminf(own, top) : top;
        }
    return own;
}

static float share_at(const float *filled, const int n[3], int x, int y, int z)
{
    float column[3];
    for (int c = -1; c <= 1; c++)
        column[c + 1] = inside(n, x, y, z + c) ? filled[at(n, x, y, z + c)] : 0;
    const bool on_heap = column[1] > 0 || (column[1] == 0 && column[0] > 0);
    double sum = 0;
    for (int c = -1; c <= 1; c++)
        for (int b = -1; b <= 1; b++)
            for (int a = -1; a <= 1; a++) {
                const int off = abs(a) + abs(b) + abs(c);
                if (off > 2 || !inside(n, x + a, y + b, z + c))
                    continue;
                const double fill = (double)filled[at(n, x + a, y + b, z + c)],
                             share = (double)(off == 0   ? SHARE_SELF
                                              : off == 1 ? SHARE_FACE
                                                         : SHARE_EDGE);
                sum += share * (fill >= 0           ? fill
                                : !on_heap          ? -fill
                                : column[c + 1] < 0 ? 1
                                                    : (double)column[c + 1]);
            }
    return (float)sum;
}

float *heap_ref_share(const float *loose, const int n[3], double repose_deg, int sweeps)
{
    const size_t all = (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
    const double repose = tan(repose_deg * M_PI / 180);
    struct columns c = {
        .n = n, .loose = loose, .height = malloc(all * sizeof(float)), .base = malloc(all * sizeof(float))};
    float *after = malloc(all * sizeof *after), *filled = malloc(all * sizeof *filled);
    begin(&c);
    for (int s = 0; s < sweeps; s++) {
        slide(&c, repose, after);
        memcpy(c.height, after, all * sizeof *after);
    }
    for (int z = 0; z < n[2]; z++)
        for (int y = 0; y < n[1]; y++)
            for (int x = 0; x < n[0]; x++) {
                const size_t i = at(n, x, y, z);
                filled[i] = loose[i] < 0 ? loose[i] : deposits_in(&c, x, y, z, loose[i]);
            }
    for (int z = 0; z < n[2]; z++)
        for (int y = 0; y < n[1]; y++)
            for (int x = 0; x < n[0]; x++)
                after[at(n, x, y, z)] = share_at(filled, n, x, y, z);
    free(c.height);
    free(c.base);
    free(filled);
    return after;
}
