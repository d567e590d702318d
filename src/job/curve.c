#include "job/job.h"

/* The curve's keys on both sides of a frame, and the weight of the later one. */
struct between {
    size_t low, high;
    double u;
};

static struct between between(const struct curve *c, double frame)
{
    if (frame <= c->frame[0])
        return (struct between){0, 0, 0};
    if (frame >= c->frame[c->n - 1])
        return (struct between){c->n - 1, c->n - 1, 0};
    size_t low = 0, high = c->n - 1; /* frame[low] <= frame < frame[high] */
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (c->frame[middle] <= frame)
            low = middle;
        else
            high = middle;
    }
    if (c->ease == EASE_STEP)
        return (struct between){low, low, 0};
    double u = (frame - c->frame[low]) / (c->frame[high] - c->frame[low]);
    if (c->ease == EASE_SMOOTH)
        u = u * u * (3 - 2 * u);
    return (struct between){low, high, u};
}

double curve_at(const struct curve *c, double frame)
{
    struct between b = between(c, frame);
    return c->value[b.low] + (c->value[b.high] - c->value[b.low]) * b.u;
}

void track_at(const struct curve *c, double frame, double out[3])
{
    struct between b = between(c, frame);
    for (size_t a = 0; a < 3; a++)
        out[a] = c->value[3 * b.low + a] + (c->value[3 * b.high + a] - c->value[3 * b.low + a]) * b.u;
}

/* No ease overshoots, so the extremes are at keys. */
double curve_min(const struct curve *c)
{
    double min = c->value[0];
    for (size_t i = 1; i < c->n; i++)
        if (c->value[i] < min)
            min = c->value[i];
    return min;
}

double curve_max(const struct curve *c)
{
    double max = c->value[0];
    for (size_t i = 1; i < c->n; i++)
        if (c->value[i] > max)
            max = c->value[i];
    return max;
}
