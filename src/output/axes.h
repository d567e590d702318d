/* Conversion from the simulator's axes (z up) to those of files (output.up). y up is a rotation about x, so triangles keep their
 * orientation. */
#ifndef HOODOO_AXES_H
#define HOODOO_AXES_H

#include "job/job.h"

/* 0 - y instead of -y avoids negative zeros. */
static inline void axes_turn(const float sim[3], int up, float file[3])
{
    file[0] = sim[0];
    file[1] = up == OUTPUT_UP_Y ? sim[2] : sim[1];
    file[2] = up == OUTPUT_UP_Y ? 0 - sim[1] : sim[2];
}

static inline void axes_turn_exact(const double sim[3], int up, double file[3])
{
    file[0] = sim[0];
    file[1] = up == OUTPUT_UP_Y ? sim[2] : sim[1];
    file[2] = up == OUTPUT_UP_Y ? 0 - sim[1] : sim[2];
}

#endif
