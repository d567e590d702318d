#include "resample/split.h"

#include <math.h>
#include <stddef.h>

void split_normal(const double fill[27], double normal[3])
{
    static const double weight[3] = {1, 2, 1};
    for (int a = 0; a < 3; a++)
        normal[a] = 0;
    for (int z = 0; z < 3; z++)
        for (int y = 0; y < 3; y++)
            for (int x = 0; x < 3; x++) {
                const double f = fill[9 * z + 3 * y + x];
                normal[0] -= (x - 1) * weight[y] * weight[z] * f;
                normal[1] -= (y - 1) * weight[z] * weight[x] * f;
                normal[2] -= (z - 1) * weight[x] * weight[y] * f;
            }
}

static double cube(double x)
{
    return x > 0 ? x * x * x : 0;
}

double split_below(const double normal[3], double d, const double low[3], double s)
{
    /* Formula of Scardovelli and Zaleski, 2000, for the unit cube, m >= 0 with sum 1, and m . y <= alpha. It divides by the components,
     * so that none may be 0: the plane is tilted by at most a thousandth. */
    double m[3], sum = 0, alpha = d;
    for (int a = 0; a < 3; a++)
        sum += fabs(normal[a]);
    for (int a = 0; a < 3; a++) {
        m[a] = fmax(fabs(normal[a]), 1e-3 * sum);
        alpha -= normal[a] * (normal[a] < 0 ? low[a] + s : low[a]);
    }
    const double total = m[0] + m[1] + m[2];
    /* The tilt is about the middle of the cube. */
    alpha = 0.5 + (alpha / s - 0.5 * sum) / total;
    if (alpha <= 0 || alpha >= 1)
        return alpha > 0;
    double volume = cube(alpha);
    for (int a = 0; a < 3; a++) {
        m[a] /= total;
        volume += cube(alpha - 1 + m[a]) - cube(alpha - m[a]);
    }
    return fmin(fmax(volume / (6 * m[0] * m[1] * m[2]), 0), 1);
}

/* The shares below the plane at d; returns their mean. */
static double cut(int k, const double normal[3], double d, const float *most, float *share)
{
    const double s = 1.0 / k;
    double sum = 0;
    size_t i = 0;
    for (int z = 0; z < k; z++)
        for (int y = 0; y < k; y++)
            for (int x = 0; x < k; x++, i++) {
                const double low[3] = {x * s - 0.5, y * s - 0.5, z * s - 0.5};
                share[i] = (float)fmin((double)most[i], split_below(normal, d, low, s));
                sum += (double)share[i];
            }
    return sum * s * s * s;
}

enum { SPLIT_VOXELS = SPLIT_MOST * SPLIT_MOST * SPLIT_MOST };

/* Adds `more` to the shares, in proportion to what each lacks to full[i], or to 1. */
static void fill_up(size_t n, double more, const float *full, float *share)
{
    double room = 0;
    for (size_t i = 0; i < n; i++)
        room += (double)((full ? full[i] : 1) - share[i]);
    for (size_t i = 0; i < n && room > 0; i++) {
        const double lack = (double)((full ? full[i] : 1) - share[i]);
        share[i] = (float)((double)share[i] + fmin(1, more / room) * lack);
    }
}

/* Shares below a plane whose mean is `fill`, which is less than that of most[]. */
static void cut_to(int k, double fill, const double normal[3], const float *most, float *share)
{
    enum { HALVINGS = 40 };
    const double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    const double unit[3] = {normal[0] / length, normal[1] / length, normal[2] / length};
    double low = -1, high = 1;
    for (int i = 0; i < HALVINGS; i++) {
        const double middle = (low + high) / 2;
        *(cut(k, unit, middle, most, share) < fill ? &low : &high) = middle;
    }
    cut(k, unit, high, most, share);
}

/* Gives slivers to the voxels that have more. */
static void drop_slivers(size_t n, const float *most, double least, float *share)
{
    float full[SPLIT_VOXELS];
    double lost = 0;
    for (size_t i = 0; i < n; i++) {
        if ((double)share[i] < least) {
            lost += (double)share[i];
            share[i] = 0;
        }
        full[i] = share[i] > 0 ? most[i] : 0;
    }
    fill_up(n, lost, full, share);
}

void split_voxel(int k, double fill, double first, const double normal[3], const float *most, double least,
                 float *share)
{
    const size_t n = (size_t)k * (size_t)k * (size_t)k;
    float at_first[SPLIT_VOXELS];
    double room = 0;
    for (size_t i = 0; i < n; i++) {
        at_first[i] = first > 0 ? most[i] : 1;
        share[i] = at_first[i];
        room += (double)at_first[i];
    }
    const double more = first > 0 && fill >= first ? fill - first : fill - room / (double)n;
    if (more >= 0) {
        fill_up(n, more * (double)n, NULL, share);
        return;
    }
    if (fabs(normal[0]) + fabs(normal[1]) + fabs(normal[2]) > 1e-6)
        cut_to(k, fill, normal, at_first, share);
    else
        for (size_t i = 0; i < n; i++)
            share[i] = (float)((double)at_first[i] * fill * (double)n / room);
    drop_slivers(n, at_first, least, share);
}
