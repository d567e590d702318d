/* The interface between model.c, which does what is the same for all models, and the models. A model is a table of functions (struct
 * model_type) and a row in src/job/keys.def. Only files of src/model include this header. */
#ifndef HOODOO_MODEL_TYPE_H
#define HOODOO_MODEL_TYPE_H

#include "erosion/budget.h"
#include "field/aov.h"
#include "field/field.h"
#include "frame/host.h"
#include "model/model.h"
#include "model/numbers.h"

struct model_type;
struct resampling;

/* The first member of every model's own struct. */
struct model {
    const struct model_type *type;
    struct gpu *gpu;
    const struct job *whole; /* the job as loaded */
    const struct job *job;   /* the job with the edits up to this frame */
    int frame;
    double years; /* since the first frame */
    int voxels[3];
    double h;            /* m: side of a voxel */
    double start_volume; /* m3 */
    struct ledger ledger;
    struct budget budget;      /* only if the model has processes */
    int64_t change[PROCESSES]; /* quanta, in the last frame */
    struct gpu_work *work;
    struct field field;
    struct aov aov;                                            /* only if the job has pictures */
    enum { MAKES_FILES, MAKES_PICTURES, MAKES_NUMBERS } makes; /* see model_pictures() and model_measure() */
    const struct particles
        *shown;            /* the rock as particles; NULL while the device does not have it in that form */
    struct particles made; /* of a frame, by models whose state is not particles; until model_release() */
    bool streams;          /* see model_stream() */
    void (*stage)(void *user, int frame, const char *name); /* see model_on_stage() */
    void *stage_user;
    struct gpu_buffer *found; /* numbers.h */
};

/* What is written of the current frame. output() makes nothing else. */
struct frame_wants {
    bool points, volumes, pictures;
    bool air; /* for files or pictures */
};
struct frame_wants model_wants(const struct model *m);

/* A model's estimate for a job. model.c adds what all models need: the index of particles, scratch memory, the surface field, pictures,
 * and frames waiting to be written. */
struct model_needs {
    const int *voxels;         /* of the domain; input */
    struct scene_size size;    /* of the rock that frames show; the caller frees size.point */
    struct disk_particle disk; /* disk space of one particle */
    uint64_t disk_other;       /* bytes per frame of files that only this model has */
    size_t capacity;           /* particles for which the device has buffers */
    uint64_t device_bytes;     /* of the model's own buffers */
    struct host_frame frame;   /* its `grids` counts only those that not all models have (values.def) */
    uint64_t host_bytes;       /* of the model's own arrays */
    uint64_t checkpoint_bytes;
    double steps;
    int kernels; /* about how many run; on a CPU device each is compiled into the process */
};

struct model_type {
    size_t size; /* of the model's own struct, which starts with struct model */

    MUST_USE status (*estimate)(const struct job *job, struct model_needs *needs);

    /* Items of scratch memory (gpu_work_create()) that the model needs for this job, with its edits. */
    size_t (*work_items)(const struct job *job, const int voxels[3]);

    /* Creates what does not depend on the rock: buffers and tables. */
    MUST_USE status (*create)(struct model *m);

    /* Makes the job's first frame, with ledger and start volume. */
    MUST_USE status (*begin)(struct model *m);

    /* Restores the state of a checkpoint. model.c has checked its domain and read what sections_add_counts() wrote. */
    MUST_USE status (*restore)(struct model *m, const struct checkpoint *from);

    /* Frees what the three functions above made, also if they failed halfway. */
    void (*destroy)(struct model *m);

    /* Simulates one frame. Its number, years and job are set, and the budget is empty. */
    MUST_USE status (*step)(struct model *m);

    /* Adds the model's own arrays that outlive the stage that has ended (numbers.h); may be NULL. The list already has the fields of
     * `shown` and the surface field. */
    void (*watch)(const struct model *m, struct watch_list *list);

    /* Fills in the frame's volume and stress, and the parts that model_wants() names. Number, years, ledger, start volume and changes are
     * filled in already. Grids are begun with model_grids(); what their samples are read from must stay until release(). */
    MUST_USE status (*output)(struct model *m, struct frame *out);

    /* The samples of a grid of terrain (FROM_TERRAIN), which the model has added; may be NULL. */
    MUST_USE status (*read_terrain)(struct model *m, enum value_id which, float *out);

    /* Frees what output() has kept for the frame's grids, besides `made`; may be NULL. Harmless without a frame. */
    void (*release)(struct model *m);

    /* Adds the model's sections, and calls sections_add_counts(). The section of the domain is there already. */
    MUST_USE status (*save)(struct model *m, struct checkpoint *out);

    /* Adds to r->out the model's sections of the checkpoint r->from at another spacing, but no counts, which it puts into r->counts
     * (resampling.h). E_CHECKPOINT: damaged, or this state cannot be resampled. */
    MUST_USE status (*resample)(struct resampling *r);
};

/* The model of a job. */
const struct model_type *model_type_of(const struct job *job);

/* Whether an array that stage `by` writes and stage `before` reads must be checked now: after `by`, and before `before`, a checkpoint or
 * the frame's field. */
bool watch_between(const struct watch_list *list, const char *by, const char *before);

/* Lists the field's grids (field_grids()). Their samples, and those of grids that the model adds, are read from the model: by
 * model_output() or, if it streams, when they are written. */
MUST_USE status model_grids(struct model *m, unsigned has, struct frame_grids *out);

/* The sum of n shares of voxels or particles that are left. */
double model_sum(const float *left, size_t n);

/* Enter the total of `left` (n shares on the device) before and after a process into the frame's budget; the difference is what the
 * process changed. Record only. */
void model_budget_before(struct model *m, enum process process, struct gpu_buffer *left, size_t n);
void model_budget_after(struct model *m, enum process process, struct gpu_buffer *left, size_t n);

/* In the first frame, logs how much rock was removed because nothing supports it. `lowest`: foot of the lowest voxel that was at least
 * half rock, m, or HUGE_VAL if there was none; `whole`: such a voxel remains. E_USAGE: nothing remains, or there was such a voxel and
 * none remains. */
MUST_USE status model_check_supported(const struct model *m, double lowest, bool whole);

/* Adds the ledger and, for a model with processes (keys.def), start volume and changes. */
MUST_USE status sections_add_counts(struct checkpoint *c, const struct model *m);

#endif
