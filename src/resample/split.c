#include "resample/split.h"

#include <math.h>

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

/* The B-spline at o, -1/2 to 1/2 from the voxel's centre, and the direction in which it falls. */
static double spline(const double fill[27], const double o[3], double falls[3])
{
    double w[3][3], slope[3][3], f = 0;
    for (int a = 0; a < 3; a++) {
        w[a][0] = 0.5 * (0.5 - o[a]) * (0.5 - o[a]);
        w[a][1] = 0.75 - o[a] * o[a];
        w[a][2] = 0.5 * (0.5 + o[a]) * (0.5 + o[a]);
        slope[a][0] = 0.5 - o[a];
        slope[a][1] = 2 * o[a];
        slope[a][2] = -0.5 - o[a];
        falls[a] = 0;
    }
    for (int e = 0; e < 27; e++) {
        const int x = e % 3, y = e / 3 % 3, z = e / 9;
        f += fill[e] * w[0][x] * w[1][y] * w[2][z];
        falls[0] += fill[e] * slope[0][x] * w[1][y] * w[2][z];
        falls[1] += fill[e] * w[0][x] * slope[1][y] * w[2][z];
        falls[2] += fill[e] * w[0][x] * w[1][y] * slope[2][z];
    }
    return f;
}

double split_smooth(const double fill[27], double level, int k, int e)
{
    const double s = 1.0 / k, low[3] = {-0.5 * s, -0.5 * s, -0.5 * s},
                 o[3] = {(e % k + 0.5) * s - 0.5, (e / k % k + 0.5) * s - 0.5, (e / (k * k) + 0.5) * s - 0.5};
    double falls[3];
    const double f = spline(fill, o, falls);
    if (fabs(falls[0]) + fabs(falls[1]) + fabs(falls[2]) < 1e-9)
        return f > level;
    return split_below(falls, f - level, low, s);
}

void split_evenly(size_t n, double fill, double first, const float *most, float *share)
{
    double had = 0;
    for (size_t i = 0; i < n; i++) {
        share[i] = first > 0 ? most[i] : 1;
        had += (double)share[i];
    }
    const double more = (first > 0 && fill >= first ? fill - first : fill - had / (double)n) * (double)n,
                 room = (double)n - had;
    for (size_t i = 0; i < n; i++)
        if (more > 0)
            share[i] = (float)((double)share[i] + fmin(more / fmax(room, more), 1) * (1 - (double)share[i]));
        else
            share[i] = (float)((double)share[i] * (1 + more / fmax(had, -more)));
}
