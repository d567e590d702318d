/* The data that `hoodoo report` gathers from an output folder, and the functions that gather and show it.
 *
 * Calling sequence   report_gather(), report_pictures(), report_page(), report_free(). Missing or damaged parts of a
 *                    folder are omitted with a sentence in `notes`; only failures to make the page itself are errors.
 */
#ifndef HOODOO_REPORT_H
#define HOODOO_REPORT_H

#include "job/job.h"
#include "output/product.h"
#include "system/child.h"
#include "text/json.h"

struct report_frame {
    struct manifest manifest;
    bool damaged;
    char what[512];     /* description of the damage */
    struct path source; /* path of a picture relative to root: the still, else the AOVs; "": none */
    bool has_volumes;
    bool pictured, thumb; /* report/frame.1001.jpg and report/thumb.1001.jpg exist */
};

enum { STRESS_BINS = 48 };

/* Distribution of stress over one kind of sample, in the last frame that has them. */
struct report_stress {
    int frame;
    const char *what;          /* "particles", "surface particles", "voxels" */
    size_t n;                  /* 0: unknown */
    double low, high;          /* MPa: range of the bins; the outermost bins include values beyond it */
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
    struct report_frame *frame; /* frames with a manifest, ascending */
    int *checkpoint;            /* newest first */
    size_t n_checkpoints;
    uint64_t disk; /* bytes in the files of all frames */
    struct json *run;
    struct json **timing; /* one per line of log/timing.jsonl */
    size_t n_timing;
    struct report_stress stress;
    struct report_layer *layer; /* [job->n_strata]; NULL: unknown from the points */
    int layers_from, layers_to;
    bool stills; /* at least one picture comes from `hoodoo preview` */
    bool video;  /* report/turntable.mp4 */
    int n_views; /* of report/view.000.jpg and following */
    int turntable_frame;
    char *log;         /* the end of log/run.log, or NULL */
    struct text notes; /* sentences, one per line */
    const int *mark;   /* a frame that curves mark; NULL: none */
};

/* The command that makes a page and its pictures, for their records. */
struct recipe report_recipe(const char *root);

/* Adds a formatted line to the notes. */
void report_note(struct report *r, const char *format, ...) PRINTF_LIKE(2, 3);

/* Fills *out from the files of the folder. E_INPUT: not an output folder. E_MEMORY. */
MUST_USE status report_gather(const char *root, struct report *out);

/* Creates report/ with the pictures of the page; oiiotool converts them. A picture that fails becomes a note. E_OUTPUT;
 * STOPPED as in children.h. */
MUST_USE status report_pictures(struct report *r);

/* *out: the complete HTML page. E_MEMORY. */
MUST_USE status report_page(const struct report *r, struct text *out);

void report_free(struct report *r);

#endif
