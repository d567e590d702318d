#include "stacks/intervals.h"

#include <math.h>

#include "base/memory.h"

struct finder {
    height_function f;
    void *user;
    struct intervals *out;
    bool in;
    double z, value; /* the last sample */
};

static status open_at(struct finder *s, double z)
{
    status st = memory_grow(&s->out->at, &s->out->capacity, s->out->n + 1, sizeof *s->out->at, "intervals");
    if (st == OK)
        s->out->at[s->out->n++] = (struct interval){z, z};
    return st;
}

/* The root between a and b, where f is fa and fb: regula falsi, which halves the value at an end that is kept twice (Illinois), then
 * bisection if that converges slowly. */
static double root(const struct finder *s, double a, double fa, double b, double fb)
{
    enum { MAX_STEPS = 60, MAX_FALSI_STEPS = 12 };
    double skip, small = 1e-9 * (1 + fabs(a) + fabs(b));
    int side = 0;
    for (int i = 0; i < MAX_STEPS && b - a > small; i++) {
        double z = i < MAX_FALSI_STEPS ? b - fb * (b - a) / (fb - fa) : 0.5 * (a + b);
        if (!(z > a && z < b))
            z = 0.5 * (a + b);
        double f = s->f(s->user, z, &skip);
        if (fabs(f) < 1e-9)
            return z;
        if ((f > 0) == s->in) {
            a = z;
            fa = f;
            fb *= side == 1 ? 0.5 : 1;
            side = 1;
        } else {
            b = z;
            fb = f;
            fa *= side == 2 ? 0.5 : 1;
            side = 2;
        }
    }
    return 0.5 * (a + b);
}

/* Samples f at z; opens or closes an interval if the sign has changed since the last sample. */
static status sample(struct finder *s, double z, double *skip)
{
    status st = OK;
    *skip = 0;
    double f = s->f(s->user, z, skip);
    bool in = f > 0;
    if (in != s->in) {
        double at = root(s, s->z, s->value, z, f);
        if (in)
            st = open_at(s, at);
        else
            s->out->at[s->out->n - 1].hi = at;
        s->in = in;
    }
    s->z = z;
    s->value = f;
    return st;
}

/* Is the line constantly 1 or -1 between breaks k - 1 and k? */
static bool is_pinned(const struct profile *line, size_t k)
{
    double below = line->f[k ? k - 1 : 0], above = line->f[k < line->n ? k : line->n - 1];
    return fmin(fabs(below), fabs(above)) > 1 - 1e-9 && (below > 0) == (above > 0);
}

status intervals_find(double lo, double hi, double step, const struct profile *line, bool pinned,
                      height_function f, void *user, struct intervals *out)
{
    status st = OK;
    struct finder s = {f, user, out, false, lo, 0};
    double skip = 0;
    out->n = 0;
    if (!(hi > lo))
        return OK;
    /* If f > 0 at lo, the first interval begins there. */
    s.value = f(user, lo, &skip);
    s.in = s.value > 0;
    if (s.in)
        TRY(open_at(&s, lo));
    for (size_t k = 0; s.z < hi; k++) {
        /* To the line's next break, or the end. */
        double to = line && k < line->n ? fmin(line->z[k], hi) : hi;
        bool flat = pinned && line && is_pinned(line, k);
        while (s.z < to) {
            double next = s.z + fmax(step, skip);
            TRY(sample(&s, flat || next > to - 0.1 * step ? to : next, &skip));
        }
    }
    if (s.in)
        out->at[out->n - 1].hi = hi;
done:
    return st;
}
