/* What a self-test found: a row for each check, as Markdown for people and JSON for programs. */
#ifndef HOODOO_SELFTEST_FINDINGS_H
#define HOODOO_SELFTEST_FINDINGS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/text.h"
#include "gpu/gpu.h"

enum { VALUES_MOST = 12, PACES_MOST = 3, STAGES_MOST = 32 };

/* One check. It is ok until row_wrong() says otherwise. */
struct row {
    const char *group; /* "kernels" */
    char name[20];
    bool ok;
    double seconds;
    char found[48]; /* for people, short */
    char why[512];  /* of one that is not ok */
    size_t n_values;
    struct row_value {
        const char *name; /* a literal, with its unit: "seconds_a_frame" */
        double value;
    } value[VALUES_MOST];
};

void row_found(struct row *row, const char *format, ...) PRINTF_LIKE(2, 3);
void row_value(struct row *row, const char *name, double value);

/* The first thing wrong with a row is kept; later ones are dropped. */
void row_wrong(struct row *row, const char *format, ...) PRINTF_LIKE(2, 3);

/* How fast the demo goes at one spacing. */
struct pace {
    double spacing_m;
    size_t n_particles;
    double start_seconds, frame_seconds, dispatches; /* of a frame, mean */
    struct gpu_time stage[STAGES_MOST];              /* of a frame, mean */
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
    double seconds;     /* that passed */
    double cpu_seconds; /* of all processors together */
};

void findings_free(struct findings *r);

/* NULL if all rows are ok. */
const struct row *findings_first_wrong(const struct findings *r);

/* Lines of 80 columns at most. */
MUST_USE status findings_markdown(const struct findings *r, struct text *out);

/* An object; `format` is 1 until a member changes its meaning or goes. */
MUST_USE status findings_json(const struct findings *r, struct text *out);

#endif
