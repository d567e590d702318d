/* The kinds of tasks, from kinds.def. */
#ifndef HOODOO_FARM_KINDS_H
#define HOODOO_FARM_KINDS_H

#include "job/job.h"
#include "output/folder.h"

enum farm_kind {
#define KIND(word, ...) FARM_##word,
#include "farm/kinds.def"
    FARM_KINDS
};

/* Kinds in groups, by which reports name them and job keys (farm.sim, farm.derive ...) set what they request. */
#define FARM_STAGES(X) X(SIM, sim) X(DERIVE, derive) X(PREVIEW, preview) X(FINISH, finish)
enum farm_stage {
#define FARM_STAGE(constant, word) STAGE_##constant,
    FARM_STAGES(FARM_STAGE)
#undef FARM_STAGE
};

/* What one task of a kind covers. */
enum farm_cut {
    CUT_BLOCKS,     /* a block of frames, after the block before it */
    CUT_CHUNKS,     /* up to farm.chunk_frames frames of a block, after the block */
    CUT_LIST,       /* the same; in OpenJD templates a parameter lists the frames */
    CUT_VIEWS,      /* up to farm.chunk_frames views of the last frame's turntable */
    CUT_ONCE,       /* all frames of a wedge */
    CUT_LAST,       /* the last frame of a wedge */
    CUT_ALL_WEDGES, /* all wedges together, if more than one has what the task is made of */
    CUT_JOB         /* the whole job, once all other tasks have ended, whether they succeeded or not */
};

struct farm_task;

struct farm_kind_info {
    const char *name; /* prefix of its tasks' names: lower-case letters */
    enum farm_stage stage;
    const char *step; /* name of its OpenJD step */
    enum farm_cut cut;
    unsigned
        after; /* AFTER(kind) | ...: the kinds it waits for, within its wedge; for SIM, the last block. Blocks and chunks have none */
    bool device;         /* runs on a Vulkan device; other kinds use CPU cores only */
    bool side_by_side;   /* its command starts a renderer process on each of its cores */
    const char *command; /* the arguments after `hoodoo`: command.h */

    /* How many tasks of each frame range the job wants: 0, 1, or one for each value of a list. NULL: one. */
    size_t (*wanted)(const struct job *job);
    const char *(*value)(const struct job *job, size_t i); /* of that list; NULL: no list */
    /* Whether it makes or shows this frame. NULL: every frame. */
    bool (*takes)(const struct job *job, int frame);

    /* The file it makes of a frame, and the file it makes it from. It is done when all its files exist and none is older than its
     * source. A file's name contains a part (folder_name()): the value it shows, or one of the frame's parts. */
    enum folder_file makes, from;
    size_t (*parts)(const struct job *job); /* NULL: one */
    const char *(*part)(const struct job *job, size_t i);

    /* Cost of an item: seconds of one core, plus so many for each particle of the rock; bytes on disk, plus so many for each
     * particle of its surface. Measured on the frames of jobs/demo.yaml; they tell a minute from an hour, no more. */
    double seconds, particle_seconds, bytes, surface_bytes;
    /* Memory of each of its processes besides hoodoo's own (MEMORY_OF_HOODOO), plus so much for each particle: measured on the same
     * frames at three spacings. Not of SIM, whose model has an estimate. */
    double memory, particle_memory;
    size_t (*items)(const struct job *job, const struct farm_task *task); /* NULL: its frames */
};

#define AFTER(word) (1u << FARM_##word)

/* Bytes of the hoodoo process of a task that uses no device. */
#define MEMORY_OF_HOODOO 40e6

extern const struct farm_kind_info farm_kinds[FARM_KINDS];

/* "sim", "derive", "preview" or "finish". */
const char *farm_stage_name(enum farm_kind kind);

/* Whether tasks of this kind each make a part of what the kind makes. */
bool farm_kind_is_cut(enum farm_kind kind);

/* Whether a task of this kind uses a GPU, given --device. `device`: NULL for any. The CPU is not a GPU. */
bool farm_wants_gpu(enum farm_kind kind, const char *device);

#endif
