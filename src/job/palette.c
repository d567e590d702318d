#include "job/palette.h"

void palette_color(const struct job *job, size_t layer, float rgb[3])
{
    /* Navajo buff, iron red, salmon, ochre, cream, rust: no two neighbours alike. */
    static const float stone[][3] = {{0.55f, 0.30f, 0.16f}, {0.40f, 0.14f, 0.065f}, {0.62f, 0.33f, 0.21f},
                                     {0.52f, 0.32f, 0.11f}, {0.70f, 0.50f, 0.31f},  {0.33f, 0.125f, 0.07f}};
    const float *own = stone[layer % (sizeof stone / sizeof *stone)];
    const double *given = job->strata[layer].color;
    bool use = given[0] >= 0 && given[1] >= 0 && given[2] >= 0;
    for (int i = 0; i < 3; i++)
        rgb[i] = use ? (float)given[i] : own[i];
}
