/* What `hoodoo verify` has found so far, and what would make it anew. */
#ifndef HOODOO_VERIFY_H
#define HOODOO_VERIFY_H

#include "base/text.h"
#include "output/product.h"

/* A command that makes damaged products anew. */
struct remake {
    size_t n_words;
    char **word;     /* owned */
    int first, last; /* the frames it is to make; ALL_FRAMES: it takes none */
    bool late;       /* it is made of other products */
};

struct search {
    const char *root;
    char name[256];
    struct frame_range frames; /* step 0: the job cannot be read, and they are not known */
    bool json, only_frames;    /* --frames: checkpoints, and what is of all frames, are not asked for */
    bool bad_job;              /* said of job.yaml already */
    uint64_t job_hash;         /* of the frames' job */
    uint64_t files_hash;       /* of what else of job.yaml is in the files of frames */
    size_t n_frames, n_files, n_products, n_checkpoints, n_bad_checkpoints, n_damaged, n_missing;
    size_t n_others; /* of the damaged and missing: those that `hoodoo run` does not make */
    struct remake *remake;
    size_t n_remakes, remake_capacity;
    struct text answer; /* where json is set: so far up to the list of problems */
};

/* Says it, and counts it. */
void found(struct search *s, bool missing, const char *path, const char *what);

/* Everything that has a record. E_MEMORY alone ends the search. */
MUST_USE status verify_products(struct search *s);

/* `hoodoo run` is needed, for frames or checkpoints. */
MUST_USE status remake_run(struct search *s, bool repair);

/* "'hoodoo run' and then 'hoodoo mesh OUT --missing' make", and the same as a list of a JSON object, in the order in which they are to be
 * given. */
MUST_USE status remake_text(const struct search *s, struct text *out);
MUST_USE status remake_json(struct search *s);
void remakes_free(struct search *s);

#endif
