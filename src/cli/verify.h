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

/* What was found in all folders. */
struct verdict {
    bool json;
    size_t n_frames, n_files, n_products, n_checkpoints, n_damaged, n_missing;
    struct text answer;   /* with json: the output so far, up to the list of problems */
    struct text commands; /* that repair, in order, one per line */
};

/* The search of one output folder. */
struct search {
    struct verdict *verdict;
    const char *root;
    const char *prefix; /* of its paths in the answer: "", or "w0001/" for a wedge */
    const char *farm;   /* the farm's output folder, if this is a wedge's; or NULL */
    int wedge;
    char name[256];
    struct frame_range frames; /* step 0: unknown, because the job cannot be read */
    bool only_frames;          /* --frames is given, which excludes checkpoints and products of all frames */
    bool bad_job;              /* a problem with job.yaml was already reported */
    struct job_states states;  /* of the job; n is 0 if job.yaml cannot be compared with the frames */
    uint64_t files_hash;       /* of the keys of job.yaml that affect the files of frames only; 0: unknown */
    size_t n_bad_checkpoints;
    size_t n_problems,
        n_others; /* n_others: of the problems, those in files that `hoodoo run` does not make */
    struct product_list listed; /* the files that sound manifests list, for verify_strays() */
    int *sound;                 /* [n_sound]: frames with a sound manifest */
    size_t n_sound, sound_capacity;
    struct remake *remake;
    size_t n_remakes, remake_capacity;
};

/* Reports and counts a problem of the file `path`, relative to the folder. */
void report_problem(struct search *s, bool missing, const char *path, const char *what);

/* Checks every product that has a record, and looks for files of the job that neither a record nor a manifest lists: nothing tells whether
 * they are whole, or from what they were made. Only E_MEMORY ends the search. */
MUST_USE status verify_products(struct search *s);

/* Appends to verdict->commands what repairs this folder, in the order in which it is to be run. */
MUST_USE status remake_commands(struct search *s);

void search_free(struct search *s);

#endif
