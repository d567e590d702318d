/* What there is to know of each kind of task, from kinds.def. */
#ifndef HOODOO_FARM_KINDS_H
#define HOODOO_FARM_KINDS_H

#include "job/job.h"
#include "output/folder.h"

enum farm_kind {
#define KIND(word, ...) FARM_##word,
#include "farm/kinds.def"
    FARM_KINDS
};

/* What one task of a kind is for. */
enum farm_cut {
    CUT_BLOCKS,    /* a block of frames, after the block before it */
    CUT_CHUNKS,    /* up to farm.chunk_frames frames of a block, after the block */
    CUT_LIST,      /* the same; OpenJD's user may ask for other frames */
    CUT_VIEWS,     /* up to farm.chunk_frames views of the last frame's turntable */
    CUT_ONCE,      /* all frames of a wedge */
    CUT_LAST,      /* the last frame of a wedge */
    CUT_ALL_WEDGES /* the wedges together, where more than one has what it waits for */
};

struct farm_task;

struct farm_kind_info {
    const char *name;  /* what its tasks' names begin with: lower-case letters */
    const char *stage; /* "sim", "derive", "preview" or "finish": what people are told */
    const char *step;  /* OpenJD's step */
    enum farm_cut cut;
    unsigned after; /* AFTER(kind) | ...: of its wedge; SIM is the last block. Blocks and chunks need none */
    bool device;    /* runs on a Vulkan device; the others are for the CPU alone */
    const char *command; /* the words after `hoodoo`: command.h */

    /* How many of each the job asks for: 0 for none, 1, or one for each value of a list. NULL: one. */
    size_t (*wanted)(const struct job *job);
    const char *(*value)(const struct job *job, size_t i); /* of that list; NULL: there is none */
    /* Is this frame among those it makes or shows? NULL: all are. */
    bool (*takes)(const struct job *job, int frame);

    /* What it makes of a frame, and of which file. It is done when all are there, no older than those. The file has a
     * part in its name (folder_name()) for the value that it shows, or for each part of the frame's. */
    enum folder_file makes, from;
    size_t (*parts)(const struct job *job); /* NULL: one */
    const char *(*part)(const struct job *job, size_t i);

    /* What an item takes: seconds of one core, also for each particle of the rock, and bytes on disk, also for each
     * particle of its surface. Measured on jobs/demo.yaml's frames; they only tell a minute from an hour. */
    double seconds, particle_seconds, bytes, surface_bytes;
    size_t (*items)(const struct job *job, const struct farm_task *task); /* NULL: its frames */
};

#define AFTER(word) (1u << FARM_##word)

extern const struct farm_kind_info farm_kinds[FARM_KINDS];

/* Are there several tasks of the kind, for parts of what it makes? */
bool farm_kind_is_cut(enum farm_kind kind);

/* Does a task of this kind want a GPU, given --device? `device`: NULL for any; the CPU is none. */
bool farm_wants_gpu(enum farm_kind kind, const char *device);

#endif
