/* What every model has, and what each one adds: for the files of models alone. model.c does what is the same for all;
 * a model is a table of what it does differently, and a line in keys.def. */
#ifndef HOODOO_MODEL_TYPE_H
#define HOODOO_MODEL_TYPE_H

#include "erosion/budget.h"
#include "field/aov.h"
#include "field/field.h"
#include "model/model.h"
#include "model/numbers.h"

struct model_type;

/* The first member of every model's own struct. */
struct model {
    const struct model_type *type;
    struct gpu *gpu;
    const struct job *whole; /* as loaded */
    const struct job *job;   /* as the edits up to this frame have it */
    int frame;
    double years; /* since the first frame */
    int voxels[3];
    double h;            /* m: their side */
    double start_volume; /* m3 */
    struct ledger ledger;
    struct budget budget;      /* where the model has processes */
    int64_t change[PROCESSES]; /* quanta, in the last frame */
    struct gpu_work *work;
    struct field field;
    struct aov aov;     /* where the job has pictures */
    bool only_pictures; /* nothing else is wanted of this frame, and those in any case */
    const struct particles
        *shown;               /* the rock as particles, as long as it is on the device; NULL: it is not */
    struct gpu_buffer *found; /* numbers.h */
};

/* What is written of a frame: a model makes nothing else of it for output(). */
struct frame_wants {
    bool points, volumes, pictures;
    bool air; /* for a file or for pictures */
};
struct frame_wants model_wants(const struct model *m);

/* What a model says of a job. model.c adds what all models have: the index of particles, scratch memory, the surface
 * field, pictures, and the frames that wait to be written. */
struct model_needs {
    const int *voxels;         /* given: of the domain */
    struct scene_size size;    /* of the rock that frames show. size.point is freed by the caller */
    struct disk_particle disk; /* what one particle of it takes */
    uint64_t disk_other;       /* of a frame: files that only this model has */
    size_t room;               /* particles there is room for on the device */
    uint64_t device_bytes;     /* of the model's own buffers */
    uint64_t samples;          /* of each grid of a frame */
    uint64_t frame_bytes;      /* of a waiting frame: what only this model's frames have */
    uint64_t host_bytes;       /* of the model's own arrays */
    uint64_t checkpoint_bytes;
    double steps;
    int kernels; /* that it runs, about: on a CPU each is compiled into the process */
};

struct model_type {
    size_t size; /* of its struct */

    MUST_USE status (*estimate)(const struct job *job, struct model_needs *needs);

    /* Items of scratch memory that a model of the job's works with. */
    size_t (*work_items)(const struct job *job, const int voxels[3]);

    /* What does not depend on the rock: buffers, tables. */
    MUST_USE status (*create)(struct model *m);

    /* The job's first frame, ledger and start volume included. */
    MUST_USE status (*begin)(struct model *m);

    /* The same from a checkpoint: model.c has checked its domain and read what sections_add_counts() wrote. */
    MUST_USE status (*restore)(struct model *m, const struct checkpoint *from);

    /* Frees what the three before have made, of a model however unfinished. */
    void (*destroy)(struct model *m);

    /* One frame. Its number, its years and its job are set, and its budget is empty. */
    MUST_USE status (*step)(struct model *m);

    /* Adds what of its own lasts longer than the stage that has ended; NULL: nothing. `shown` and the surface field are there. */
    void (*watch)(const struct model *m, struct watch_list *list);

    /* Adds to a frame that has its number, years, ledger, start volume and changes: its measures, and of the rest what
     * model_wants() says. */
    MUST_USE status (*output)(struct model *m, struct frame *out);

    /* Adds its sections behind that of the domain, those of sections_add_counts() among them. */
    MUST_USE status (*save)(struct model *m, struct checkpoint *out);
};

/* Is it to be looked at here, what stage `by` makes and `before` begins with? Also before it is saved or shown. */
bool watch_between(const struct watch_list *list, const char *by, const char *before);

/* What is left of n voxels or particles, as so many whole ones. */
double model_sum(const float *left, size_t n);

/* Enters all that the rock has, before and after a process, into the frame's budget. */
void model_weigh(struct model *m, enum process process, bool after, struct gpu_buffer *left, size_t n);

/* Says in the first frame how much was taken out because nothing holds it. `lowest`: the foot of the lowest voxel that was at
 * least half rock, m; HUGE_VAL: there was none. E_USAGE: nothing is left, or `whole` says that none such is, where there was one. */
MUST_USE status model_check_stands(const struct model *m, double lowest, bool whole);

/* The ledger; and for a model with processes (keys.def), start volume and changes. */
MUST_USE status sections_add_counts(struct checkpoint *c, const struct model *m);

#endif
