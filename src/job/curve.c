#include "job/job.h"

double curve_at(const struct curve *c, double frame)
{
    if (frame <= c->frame[0])
        return c->value[0];
    if (frame >= c->frame[c->n - 1])
        return c->value[c->n - 1];
    size_t low = 0, high = c->n - 1; /* frame[low] <= frame < frame[high] */
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (c->frame[middle] <= frame)
            low = middle;
        else
            high = middle;
    }
    if (c->ease == EASE_STEP)
        return c->value[low];
    double u = (frame - c->frame[low]) / (c->frame[high] - c->frame[low]);
    if (c->ease == EASE_SMOOTH)
        u = u * u * (3 - 2 * u);
    return c->value[low] + (c->value[high] - c->value[low]) * u;
}

/* No ease overshoots, so the largest key is the largest value. */
double curve_max(const struct curve *c)
{
    double max = c->value[0];
    for (size_t i = 1; i < c->n; i++)
        if (c->value[i] > max)
            max = c->value[i];
    return max;
}
