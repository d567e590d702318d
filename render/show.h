/* Values of the surface as colours: which there are, what range of them, and what the legend says.
 *
 * A sequence must not flicker, and its pictures are made by many machines that know nothing of each other. So
 * the range comes from the job alone unless told otherwise: stress from the weight of the rock, running water
 * from the rain and the springs, shares from 0 to 1.
 */
#ifndef HOODOO_SHOW_H
#define HOODOO_SHOW_H

#include <stdbool.h>

#include "job/job.h"
#include "job/values.h"

/* "rock|stress|...": the words of --show, and the value that one of them (by its number) stands for. VALUE_NONE is the rock as
 * it looks; the others are those of values.def with a legend. */
enum { SHOW_WORDS = VALUES * (VALUE_NAME + 1) + 8 };
const char *show_words(char out[SHOW_WORDS]);
enum value_id show_of_word(int word);

/* What the colours span, in the legend's units (low < high). */
struct show_range {
    double low, high;
};

struct show_range show_job_range(enum value_id show, const struct job *job);

/* What holds all but the lowest and highest hundredth of n values (which are sorted in place), rounded outward
 * to two digits. */
struct show_range show_data_range(enum value_id show, float *values, size_t n);

/* E_USAGE: "LO:HI" is wrong, or the range makes no sense for this value. */
MUST_USE status show_parse_range(enum value_id show, const char *text, struct show_range *out);

/* Where a value stands between low and high, 0..1; beyond them at the end. */
double show_position(enum value_id show, struct show_range range, double value);

/* The colour at a position: viridis, or where both signs count blue below zero, grey, and red above. sRGB. */
void show_color(enum value_id show, struct show_range range, double position, unsigned char rgb[3]);

/* Round values for the legend, ascending; as many as *n at most. Their texts are "-0.2" or "10k". */
struct show_tick {
    double position;
    char text[16];
};
enum { SHOW_TICKS = 12 };
size_t show_ticks(enum value_id show, struct show_range range, struct show_tick tick[SHOW_TICKS]);

#endif
