/* Values as text in .usda files. */
#ifndef HOODOO_USD_TEXT_H
#define HOODOO_USD_TEXT_H

#include "text/text.h"

void usd_add_number(struct text *t, double value);
void usd_add_vector(struct text *t, const double *v, int n);
void usd_add_matrix(struct text *t, const double m[16]); /* for row vectors */

#endif
