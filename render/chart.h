/* Charts as inline SVG with axes and units, without scripts. Series differ in lightness as well as in hue. */
#ifndef HOODOO_CHART_H
#define HOODOO_CHART_H

#include <stdbool.h>
#include <stddef.h>

#include "text/text.h"

/* Adds `value`, escaped for HTML text and for attributes in double quotes: special characters become entities,
 * control characters become spaces, and bytes that are not UTF-8 become U+FFFD. */
void html_text(struct text *t, const char *value);

/* "12.3", "0.0041", "61 200": at least three significant figures, thin spaces between thousands. Returns out. */
const char *html_number(double value, char out[48]);

struct series {
    const char *name, *color;
    const double *y; /* [n], one for each x of the chart */
};

struct chart {
    const char *title, *x_label, *y_label; /* labels name the unit */
    size_t n;                              /* >= 2 */
    const double *x;                       /* ascending */
    size_t n_series;
    const struct series *series;
    bool stacked;       /* stacked areas instead of lines */
    bool from_zero;     /* the y axis includes 0 */
    const double *mark; /* an x value to mark with a line; NULL: none */
};
void chart_lines(const struct chart *c, struct text *t);

/* A labelled x value, such as a threshold. */
struct mark {
    double x;
    char name[80];
};
/* n equal bins between low and high; marks are drawn as dashed lines. */
struct histogram {
    const char *title, *x_label, *y_label;
    double low, high;
    size_t n;
    const double *share;
    size_t n_marks;
    const struct mark *mark;
};
void chart_histogram(const struct histogram *h, struct text *t);

/* Horizontal bars with names, one below the other; `note` is printed at the end of the bar. */
struct row {
    char name[96], note[96];
    const char *color;
    double value;
};
void chart_rows(const char *title, const char *x_label, const struct row *row, size_t n, double full,
                struct text *t);

#endif
