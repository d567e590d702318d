/* The data of the report's page, a JSON object that report.html shows. Each function writes some members of the object, formatted for
 * readers; the template escapes them. */
#ifndef HOODOO_REPORT_PAGE_H
#define HOODOO_REPORT_PAGE_H

#include "render/chart.h"
#include "render/report.h"

/* "erosion": rates, budget and ledger, from at least two sound frames; "rock": stress and layers, from one. */
void page_curves(const struct report *r, struct text *t);
void page_rock(const struct report *r, struct text *t);

/* The time axis: years, thousands of years, or seconds of a shot. */
struct page_clock {
    const char *label, *rate; /* "time, kyr"; denominator of rates: "kyr" */
    double unit;              /* unit of the axis, in years or seconds */
    double per;               /* time unit of rates, in units of the axis */
    double began;             /* years at the first frame: more than 0 in branches */
    bool shot;
    double now; /* position of the marked frame; NAN: none */
};
struct page_clock page_clock(const struct report *r);
/* Position of a frame on the axis. */
double page_time(const struct report *r, const struct page_clock *clock, int frame);

/* "budget": the volume that each process removed, and its rate, from manifests that contain them. */
void page_budget(const struct report *r, const struct page_clock *clock, struct text *t);
/* "timing", "provenance", and "files", "checkpoints" and "every_frame". */
void page_timing(const struct report *r, struct text *t);
void page_provenance(const struct report *r, struct text *t);
void page_files(const struct report *r, struct text *t);

/* Formatted texts: as by printf, "12.3", "1.2 MB", "1.20 kyr". Use as phrase(...).text within the statement that calls the function. */
struct phrase {
    char text[160];
};
struct phrase phrase(const char *format, ...) PRINTF_LIKE(1, 2);
struct phrase phrase_number(double value);
struct phrase phrase_bytes(uint64_t bytes);
struct phrase phrase_age(double years);

/* Adds members to the open object: `pairs` alternates names and texts; members whose text is "" are omitted. PAGE_ROW adds them as an
 * object of their own. */
#define PAGE_MEMBERS(t, ...) page_members(t, (const char *const[]){__VA_ARGS__, NULL})
#define PAGE_ROW(t, key, ...) (json_object(t, key), PAGE_MEMBERS(t, __VA_ARGS__), json_end_object(t))
void page_members(struct text *t, const char *const *pairs);

/* Adds a chart as a member and frees its text. */
void page_chart(struct text *t, const char *key, struct text *svg);

/* Adds the lines of `text` as a list; NULL: an empty one. `text` is modified meanwhile and then restored. */
void page_lines(struct text *t, const char *key, char *text);

/* The number in a member of an object; 0 if it is missing or not a number. */
double page_number(const struct json *object, const char *key);

/* `t` is an open object with a member "run" or "sweep". Closes the object, adds the page made from it to `out`, and frees `t`. E_MEMORY. */
MUST_USE status page_fill(const char *name, struct text *t, struct text *out);

#endif
