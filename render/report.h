/* What `hoodoo report` knows of a folder, and the parts that find and show it.
 *
 * Calling sequence   report_gather(), report_pictures(), report_page(), report_free(). Whatever of a folder is
 *                    missing or damaged is left out, with a sentence in `note`: only what stops the page
 *                    itself is an error.
 */
#ifndef HOODOO_REPORT_H
#define HOODOO_REPORT_H

#include "base/child.h"
#include "base/json.h"
#include "job/job.h"
#include "output/product.h"

struct report_frame {
    struct manifest manifest;
    bool damaged;
    char what[512];     /* what is wrong with it */
    struct path source; /* a picture of it, relative to root, or "": its still, or else its AOVs */
    bool has_volumes;
    bool pictured, thumb; /* report/frame.1001.jpg, report/thumb.1001.jpg are there */
};

enum { STRESS_BINS = 48 };

/* Of one kind of sample in the last frame that has them. */
struct report_stress {
    int frame;
    const char *what;          /* "particles", "surface particles", "voxels" */
    size_t n;                  /* 0: unknown */
    double low, high;          /* MPa: of the bins; the outermost hold what lies beyond */
    double share[STRESS_BINS]; /* % */
};

struct report_layer {
    double start, now; /* m3 */
};

struct report {
    const char *root;
    char name[256];
    struct job *job;
    struct frame_range frames;
    size_t n_frames, n_sound, n_damaged, n_missing;
    struct report_frame *frame; /* those with a manifest, ascending */
    int *checkpoint;            /* newest first */
    size_t n_checkpoints;
    uint64_t disk; /* bytes of all frames' files */
    struct json *run;
    struct json **timing; /* lines of log/timing.jsonl */
    size_t n_timing;
    struct report_stress stress;
    struct report_layer *layer; /* [job->n_strata], NULL if the points do not tell */
    int layers_from, layers_to;
    bool stills; /* at least one comes from `hoodoo preview` */
    bool video;  /* report/turntable.mp4 */
    int n_views; /* report/view.000.jpg and on */
    int turntable_frame;
    char *log;         /* the end of log/run.log, or NULL */
    struct text notes; /* sentences, one a line */
};

/* How a page and its pictures are made. */
struct recipe report_recipe(const char *root);

/* "kind of a note": added as a line. */
void report_note(struct report *r, const char *format, ...) PRINTF_LIKE(2, 3);

/* From the folder's files. E_INPUT: it is no output folder. */
MUST_USE status report_gather(const char *root, struct report *out);

/* Makes report/ with the pictures the page shows, through oiiotool where they need converting. STOPPED as
 * children.h has it. */
MUST_USE status report_pictures(struct report *r);

/* The page, whole. E_MEMORY. */
MUST_USE status report_page(const struct report *r, struct text *out);

void report_free(struct report *r);

#endif
