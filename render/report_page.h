/* The data of the report's page, which report.html shows: each part writes its members of a JSON object, escaped by
 * the template, with texts as people read them. */
#ifndef HOODOO_REPORT_PAGE_H
#define HOODOO_REPORT_PAGE_H

#include "render/chart.h"
#include "render/report.h"

/* "erosion": rates, budget and ledger of two sound frames at least; and "rock": stress and layers, of one. */
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

/* "budget": what each process took, and how fast, where manifests tell. */
void page_budget(const struct report *r, const struct page_clock *clock, struct text *t);
/* "timing", "provenance", and "files", "checkpoints" and "every_frame". */
void page_timing(const struct report *r, struct text *t);
void page_provenance(const struct report *r, struct text *t);
void page_files(const struct report *r, struct text *t);

/* Texts as people read them: as printf writes them, "12.3", "1.2 MB", "1.20 kyr". Used as phrase(...).text in the
 * statement that calls it. */
struct phrase {
    char text[160];
};
struct phrase phrase(const char *format, ...) PRINTF_LIKE(1, 2);
struct phrase phrase_number(double value);
struct phrase phrase_bytes(uint64_t bytes);
struct phrase phrase_age(double years);

/* Members of the object that stands open: names and texts in turns; "" is none. PAGE_ROW: of an object of their own. */
#define PAGE_MEMBERS(t, ...) page_members(t, (const char *const[]){__VA_ARGS__, NULL})
#define PAGE_ROW(t, key, ...) (json_object(t, key), PAGE_MEMBERS(t, __VA_ARGS__), json_end_object(t))
void page_members(struct text *t, const char *const *pairs);

/* A chart, whose text is freed. */
void page_chart(struct text *t, const char *key, struct text *svg);

/* A list of `text`'s lines, which is written on and as it was afterwards; NULL has none. */
void page_lines(struct text *t, const char *key, char *text);

/* A member that a file should have; 0 if it is no number. */
double page_number(const struct json *object, const char *key);

/* `t` is an object that stands open, with "run" or "sweep" in it. Closes it, adds the page of it to `out` and frees
 * it. E_MEMORY. */
MUST_USE status page_fill(const char *name, struct text *t, struct text *out);

#endif
