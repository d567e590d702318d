/* The state of `hoodoo verify`: problems found, and the commands that repair them. */
#ifndef HOODOO_VERIFY_H
#define HOODOO_VERIFY_H

#include "job/job.h"
#include "output/product.h"
#include "text/text.h"

/* A command that makes damaged or missing products again. */
struct remake {
    size_t n_words;
    char **word;     /* owned */
    int first, last; /* frames to make; ALL_FRAMES: the command takes no frames */
    bool late;       /* its input are other products */
};

struct search {
    const char *root;
    char name[256];
    struct frame_range frames; /* step 0: unknown, because the job cannot be read */
    bool json,
        only_frames; /* only_frames: --frames is given, which excludes checkpoints and products of all frames */
    bool bad_job;    /* a problem with job.yaml was already reported */
    struct job_states states; /* of the job; n is 0 if job.yaml cannot be compared with the frames */
    uint64_t files_hash;      /* of the keys of job.yaml that affect the files of frames only; 0: unknown */
    size_t n_frames, n_files, n_products, n_checkpoints, n_bad_checkpoints, n_damaged, n_missing;
    size_t n_others; /* damaged and missing files that `hoodoo run` does not make */
    struct remake *remake;
    size_t n_remakes, remake_capacity;
    struct text answer; /* with json: the output so far, up to the list of problems */
};

/* Reports and counts a problem of the file `path`. */
void report_problem(struct search *s, bool missing, const char *path, const char *what);

/* Checks every product that has a record. Only E_MEMORY ends the search. */
MUST_USE status verify_products(struct search *s);

/* Adds the command `hoodoo run`, for frames or, with `repair`, checkpoints too. */
MUST_USE status remake_run(struct search *s, bool repair);

/* The commands in the order in which they are to be run: as text, such as "hoodoo run" and then "hoodoo mesh OUT --missing"; and as
 * the JSON list `commands`. */
MUST_USE status remake_text(const struct search *s, struct text *out);
MUST_USE status remake_json(struct search *s);
void remakes_free(struct search *s);

#endif
