/* A cliff under a crust that opens into holes, and how far apart they are. */
#ifndef HOODOO_TESTS_TAFONI_H
#define HOODOO_TESTS_TAFONI_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "physics/model_help.h"

enum { WALL_MOST = 96 };         /* a cliff is so many spacings wide at most */
static const double cliff = 2;   /* m: its face stands at x */
static const double hole = 0.35; /* m */

struct tafoni {
    double apart;   /* m: openings, by how many there are */
    double share;   /* of the face that is open */
    double deepest; /* m */
    double lost;    /* m3 of it and of what is above */
    double kyr;
    int n;
};

static inline int by_depth(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* How deep each place of a cliff, h wide, lies behind what stands out: behind all but a tenth of its face; m. */
static inline void depths(struct sim *s, size_t n, double *depth)
{
    struct frame frame = sim_output(s);
    const double h = s->job->domain.spacing_m;
    for (size_t i = 0; i < n * n; i++)
        depth[i] = cliff;
    for (size_t i = 0; i < frame.rock.n; i++) {
        const float *P = &frame.rock.P[4 * i];
        const size_t y = (size_t)((double)P[1] / h), z = (size_t)((double)P[2] / h);
        const double x = (floor((double)P[0] / h) + (double)frame.rock.viability[i]) * h;
        if (y < n && z < n)
            depth[z * n + y] = fmin(depth[z * n + y], cliff - x);
    }
    frame_free(&frame);
    static double sorted[WALL_MOST * WALL_MOST];
    memcpy(sorted, depth, n * n * sizeof *sorted);
    qsort(sorted, n * n, sizeof *sorted, by_depth);
    for (size_t i = 0; i < n * n; i++)
        depth[i] -= sorted[n * n / 10];
}

/* Openings are parts of the face, of 0.03 m2 and more, that are deeper than a hole is. The share that is open. */
static inline double openings(const double *depth, size_t n, double h, struct tafoni *out)
{
    static size_t stack[WALL_MOST * WALL_MOST];
    static char seen[WALL_MOST * WALL_MOST];
    double sum = 0;
    memset(seen, 0, sizeof seen);
    out->n = 0;
    out->deepest = 0;
    for (size_t i = 0; i < n * n; i++) {
        size_t top = 0, area = 0;
        out->deepest = fmax(out->deepest, depth[i]);
        if (seen[i] || depth[i] < hole)
            continue;
        seen[i] = 1;
        stack[top++] = i;
        while (top > 0) {
            const size_t at = stack[--top], y = at % n, z = at / n;
            const size_t next[4] = {y > 0 ? at - 1 : at, y + 1 < n ? at + 1 : at, z > 0 ? at - n : at,
                                    z + 1 < n ? at + n : at};
            area++;
            for (int k = 0; k < 4; k++)
                if (!seen[next[k]] && depth[next[k]] >= hole) {
                    seen[next[k]] = 1;
                    stack[top++] = next[k];
                }
        }
        out->n += (double)area * h * h >= 0.03;
        sum += (double)area;
    }
    return sum / (double)(n * n);
}

/* A cliff `wide` metres wide and high under an old crust, until `open` of it is open, or for so many frames of 500 years. */
static inline struct tafoni weather_cliff(double h, double wide, double damp_m, int seed, int frames,
                                          double open, const char *skin)
{
    char text[2048];
    struct tafoni out = {0};
    static double depth[WALL_MOST * WALL_MOST];
    const size_t n = (size_t)lround(wide / h);
    double before = 0;
    snprintf(text, sizeof text,
             "hoodoo: 1\nname: cliff\nframes: 1-%d\nseed: %d\nclock: {years_per_frame: 500}\n"
             "domain: {size_m: [%g, %g, %g], spacing_m: %g, sides: {x_min: wall, y_min: wall, y_max: wall}}\n"
             "rock: {gravity_m_s2: 0}\nstrata: [{weak_m_per_kyr: 0.2, strong_m_per_kyr: 0.2}]\nwind: "
             "{abrasion: 0}\n"
             "noise: {amplitude: 0.3, scale_m: 1, octaves: 3}\nscene: {box: {min_m: [-1, -1, 0], max_m: [%g, "
             "99, 99]}}\n"
             "skin: {depth_m: 0.1, before_kyr: 10, damp_m: %g, %s}\n",
             frames + 1, seed, cliff + 0.4, wide, wide + 1, h, cliff, damp_m, skin);
    struct sim s = sim_begin(text);
    for (int f = 0; f < frames && out.share < open; f++) {
        const int were = out.n;
        before = out.share;
        assert_ok(model_step(s.model));
        depths(&s, n, depth);
        out.share = openings(depth, n, h, &out);
        out.kyr = 0.5 * (f + 1);
        /* as many as there were when just so much was open */
        const double then =
            out.share >= open ? were + (out.n - were) * (open - before) / (out.share - before) : out.n;
        out.apart = then > 0 ? wide / sqrt(then) : 0;
    }
    struct frame frame = sim_output(&s);
    out.lost = cliff * wide * (wide + 1) - frame.volume_m3;
    frame_free(&frame);
    sim_end(&s);
    print_message("# %g m, damp within %g m, seed %d, {%s}: after %g kyr %.0f %% is open, %d holes %.2f m "
                  "apart, down to %.2f m; %.2f m3 are lost\n",
                  h, damp_m, seed, skin, out.kyr, 100 * out.share, out.n, out.apart, out.deepest, out.lost);
    return out;
}

#endif
