/* Charts as inline SVG: axes with units, no script. Colours are told apart by lightness too. */
#ifndef HOODOO_CHART_H
#define HOODOO_CHART_H

#include <stdbool.h>
#include <stddef.h>

#include "base/text.h"

/* Adds `value` with HTML's special characters escaped, control characters as spaces, and bytes that are not
 * UTF-8 as U+FFFD: fit for text and for attributes in double quotes. */
void html_text(struct text *t, const char *value);

/* "12.3", "0.0041", "61 200": three figures at least, thin spaces between thousands. Returns out. */
const char *html_number(double value, char out[48]);

struct series {
    const char *name, *color;
    const double *y; /* [n], with the chart's x */
};

struct chart {
    const char *title, *x_label, *y_label; /* labels name the unit */
    size_t n;                              /* >= 2 */
    const double *x;                       /* ascending */
    size_t n_series;
    const struct series *series;
    bool stacked;   /* areas on one another, instead of lines */
    bool from_zero; /* the y axis holds 0 */
};
void chart_lines(const struct chart *c, struct text *t);

/* A value to point at, such as a threshold. */
struct mark {
    double x;
    char name[80];
};
/* Bars of n equal bins between low and high; marks are dashed lines. */
struct histogram {
    const char *title, *x_label, *y_label;
    double low, high;
    size_t n;
    const double *share;
    size_t n_marks;
    const struct mark *mark;
};
void chart_histogram(const struct histogram *h, struct text *t);

/* Named bars, one under the other; `note` stands at each bar's end. */
struct row {
    char name[96], note[96];
    const char *color;
    double value;
};
void chart_rows(const char *title, const char *x_label, const struct row *row, size_t n, double full,
                struct text *t);

#endif
