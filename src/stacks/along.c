#include "stacks/along.h"

#include <math.h>

#include "base/memory.h"

struct finder {
    along f;
    void *user;
    struct intervals *out;
    bool in;
    double z; /* the last sample */
};

static status open_at(struct finder *s, double z)
{
    status st = memory_grow(&s->out->at, &s->out->capacity, s->out->n + 1, sizeof *s->out->at, "intervals");
    if (st == OK)
        s->out->at[s->out->n++] = (struct interval){z, z};
    return st;
}

static double root(const struct finder *s, double a, double b)
{
    for (int i = 0; i < 30; i++) {
        double middle = 0.5 * (a + b);
        if ((s->f(s->user, middle) > 0) == s->in)
            a = middle;
        else
            b = middle;
    }
    return 0.5 * (a + b);
}

static status sample(struct finder *s, double z, bool in)
{
    status st = OK;
    if (in != s->in) {
        double at = root(s, s->z, z);
        if (in)
            st = open_at(s, at);
        else
            s->out->at[s->out->n - 1].hi = at;
        s->in = in;
    }
    s->z = z;
    return st;
}

/* Is the line 1 or -1 all the way up to break k? */
static bool is_pinned(const struct profile *line, size_t k)
{
    double below = line->f[k ? k - 1 : 0], above = line->f[k < line->n ? k : line->n - 1];
    return fmin(fabs(below), fabs(above)) > 1 - 1e-9 && (below > 0) == (above > 0);
}

status intervals_find(double lo, double hi, double step, const struct profile *line, bool pinned, along f,
                      void *user, struct intervals *out)
{
    status st = OK;
    struct finder s = {f, user, out, false, lo};
    out->n = 0;
    if (!(hi > lo))
        return OK;
    s.in = f(user, lo) > 0;
    if (s.in)
        TRY(open_at(&s, lo));
    for (size_t k = 0; s.z < hi; k++) {
        /* To the line's next break, or the end. */
        double to = line && k < line->n ? fmin(line->z[k], hi) : hi;
        if (to <= s.z)
            continue;
        bool flat = pinned && line && is_pinned(line, k);
        double from = s.z;
        int n = flat ? 1 : (int)fmin(ceil((to - from) / step), 1e7);
        for (int i = 1; i <= n; i++) {
            double z = i < n ? from + (to - from) * i / n : to;
            TRY(sample(&s, z, f(user, z) > 0));
        }
    }
    if (s.in)
        out->at[out->n - 1].hi = hi;
done:
    return st;
}
