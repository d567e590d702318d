/* The sections of the report's page, and words they share. */
#ifndef HOODOO_REPORT_PAGE_H
#define HOODOO_REPORT_PAGE_H

#include "render/chart.h"
#include "render/report.h"

/* Erosion, ledger, stress and layers: of two sound frames at least. page_rock() is of one. */
void page_curves(const struct report *r, struct text *t);
void page_rock(const struct report *r, struct text *t);
void page_timing(const struct report *r, struct text *t);
void page_provenance(const struct report *r, struct text *t);
void page_files(const struct report *r, struct text *t);

/* The page up to its heading, which stands open, and from the end of <main> on. */
void page_begin(const char *title, struct text *t);
void page_end(struct text *t);

void page_bytes(uint64_t bytes, char out[48]);
void page_age(double years, char out[48]);
/* A link to a file of the output folder; `path` is relative to it. */
void page_link(struct text *t, const char *path, const char *words);

#endif
