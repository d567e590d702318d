/* The sections of the report's page, and words they share. */
#ifndef HOODOO_REPORT_PAGE_H
#define HOODOO_REPORT_PAGE_H

#include "render/chart.h"
#include "render/report.h"

/* Erosion, ledger, stress and layers: of two sound frames at least. page_rock() is of one. */
void page_curves(const struct report *r, struct text *t);
void page_rock(const struct report *r, struct text *t);

/* The time axis: years, thousands of them, or seconds of a shot. */
struct page_clock {
    const char *label, *rate; /* "time, kyr"; what rates are per: "kyr" */
    double unit;              /* of the axis, in years or seconds */
    double per;               /* of a rate's time, in the axis' */
    bool shot;
};
struct page_clock page_clock(const struct report *r);
/* Where a frame is on it. */
double page_time(const struct report *r, const struct page_clock *clock, int frame);

/* What each process took, and how fast, where manifests tell. */
void page_budget(const struct report *r, const struct page_clock *clock, struct text *t);
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
