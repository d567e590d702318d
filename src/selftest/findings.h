/* Results of a self-test: one row per check, as Markdown for readers and JSON for programs. */
#ifndef HOODOO_SELFTEST_FINDINGS_H
#define HOODOO_SELFTEST_FINDINGS_H

#include <stdbool.h>
#include <stddef.h>

#include "gpu/gpu.h"
#include "text/text.h"

enum { VALUES_MOST = 12, PACES_MOST = 3, STAGES_MOST = 32 };

/* The result of one check; ok unless row_wrong() is called. */
struct row {
    const char *group; /* "kernels" */
    char name[20];
    bool ok;
    double seconds;
    char found[48]; /* short text for readers */
    char why[512];  /* the reason, if it is not ok */
    size_t n_values;
    struct row_value {
        const char *name; /* a literal, with its unit: "seconds_a_frame" */
        double value;
    } value[VALUES_MOST];
};

void row_found(struct row *row, const char *format, ...) PRINTF_LIKE(2, 3);
void row_value(struct row *row, const char *name, double value);

/* Marks the row as not ok. The first reason is kept; later ones are ignored. */
void row_wrong(struct row *row, const char *format, ...) PRINTF_LIKE(2, 3);

/* The speed of the demo at one spacing. */
struct pace {
    double spacing_m;
    size_t n_particles;
    double start_seconds, frame_seconds, dispatches; /* frame_seconds and dispatches: mean per frame */
    struct gpu_time stage[STAGES_MOST];              /* mean per frame */
    size_t n_stages;
};

struct findings {
    struct gpu_info device;
    struct gpu_limits limits;
    uint64_t memory_free;
    bool quick;
    struct row *row;
    size_t n_rows, capacity;
    struct pace pace[PACES_MOST]; /* coarse to fine */
    size_t n_paces;
    double seconds;     /* wall-clock time */
    double cpu_seconds; /* of all processes together */
};

void findings_free(struct findings *r);

/* The first row that is not ok; NULL if all are. */
const struct row *findings_first_wrong(const struct findings *r);

/* Adds the Markdown page, in lines of at most 80 columns. */
MUST_USE status findings_markdown(const struct findings *r, struct text *out);

/* Adds a JSON object. Its member `format` is raised whenever a member changes its meaning or is removed. */
MUST_USE status findings_json(const struct findings *r, struct text *out);

#endif
