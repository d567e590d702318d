/* Values of the surface as colours: the choices, their ranges, and the legend.
 *
 * A sequence must not flicker, and many machines may each make some of its pictures. So by default the range depends
 * on the job alone: stress on the weight of the rock, discharge on rain and sources, shares on nothing (0 to 1).
 */
#ifndef HOODOO_SHOW_H
#define HOODOO_SHOW_H

#include <stdbool.h>

#include "job/job.h"
#include "job/values.h"

/* "rock|stress|...", the choices of --show, and the value of one choice by its index. "rock" is VALUE_NONE; the others are the values of
 * values.def that have a legend. */
enum { SHOW_WORDS = VALUES * (VALUE_NAME + 1) + 8 };
const char *show_words(char out[SHOW_WORDS]);
enum value_id show_of_word(int word);

/* The range of the colours, in units of the legend (low < high). */
struct show_range {
    double low, high;
};

struct show_range show_job_range(enum value_id show, const struct job *job);

/* The range of n values (sorted in place) without the lowest and the highest hundredth, rounded outward to two
 * significant digits. */
struct show_range show_data_range(enum value_id show, float *values, size_t n);

/* Parses "LO:HI". E_USAGE: wrong syntax, or a range that is impossible for this value. */
MUST_USE status show_parse_range(enum value_id show, const char *text, struct show_range *out);

/* The position of a value between low and high, 0..1; clamped. Logarithmic for values with such a legend. */
double show_position(enum value_id show, struct show_range range, double value);

/* The sRGB colour at a position: viridis, or for values of both signs blue below zero, grey at zero and red above. */
void show_color(enum value_id show, struct show_range range, double position, unsigned char rgb[3]);

/* Round values for the legend, ascending, with texts such as "-0.2" or "10k". Returns their number, at most SHOW_TICKS. */
struct show_tick {
    double position;
    char text[16];
};
enum { SHOW_TICKS = 12 };
size_t show_ticks(enum value_id show, struct show_range range, struct show_tick tick[SHOW_TICKS]);

#endif
