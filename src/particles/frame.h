/* A finished frame in host memory, from which the writer makes files. Everything is in the simulator's axes (z up, m). */
#ifndef HOODOO_FRAME_H
#define HOODOO_FRAME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "job/job.h"
#include "particles/grids.h"
#include "particles/rock.h"

/* A channel of a camera's image: width * height values, top row first. */
struct aov_channel {
    const char *part;   /* layer of a multi-part file: rgba, depth, N, P, stress, ... */
    const char *name;   /* full channel name: "R", "Z", "N.X", "stress.trace" */
    const float *value; /* or NULL */
    const uint32_t *id; /* if value is NULL */
    int half;           /* write as half */
};

/* A text attribute of the file. */
struct aov_note {
    char name[64];
    char *value;
};

struct aov_image {
    const char *camera;
    int width, height;                            /* overscan included */
    int margin[2];                                /* px: overscan on each side in x and y */
    double world_to_camera[16], world_to_ndc[16]; /* as EXR stores them, row vectors, in the files' axes */
    size_t n_channels;
    struct aov_channel *channel;
    void *memory; /* holds all planes; owned by the frame */
    size_t n_notes;
    struct aov_note *note; /* owned by the frame */
};
void aov_image_free(struct aov_image *image);

/* Where the initial particles are: start = rock + deposit + fallen + left, exactly. */
struct ledger {
    uint64_t start, rock, deposit, fallen, left;
};

/* The change of the rock's volume by a process since the previous frame. All of them add up to the whole change. */
struct frame_change {
    const char *process; /* static string */
    double m3;           /* negative: removed */
};

/* Rocks of the frame's piles, drawn as instances: P, id, and in `layer` the number of the tile's shape. */
struct frame_rocks {
    bool wanted;
    struct rock at;
    size_t n_shapes;
    float (*box)[2][3]; /* [n_shapes] m: bounding box of each shape, relative to P */
};

/* Rock of the frame that has no particles (particles/deep.h) but is shown in files; pieces.h makes its particles. */
enum { DEEP_VALUES = 3 };
struct frame_deep {
    int voxels[3]; /* of the domain; 0: the model has no deep rock */
    double h;      /* m: voxel size */
    size_t n;
    uint32_t *bits;            /* [held_words()] its voxels; NULL if n is 0 */
    float *value[DEEP_VALUES]; /* [n] in voxel order: stress, von Mises stress, erodibility */
    /* Makes the STATE fields of the particles of some voxels. Thread-safe; valid as long as the model exists. */
    const void *source;
    status (*make)(const void *source, const uint32_t *bits, struct rock *out);
};

/* The contents of a file that the model has encoded itself; NULL: none. */
struct frame_bytes {
    void *bytes;
    size_t size;
};

struct frame {
    int number;
    double years; /* since the first frame */
    struct rock rock;
    struct frame_deep deep;
    struct frame_grids grids;
    struct frame_grids air; /* the wind; without a grid if it is uniform or not requested */
    struct frame_rocks rocks;
    struct frame_bytes stacks; /* arches: the .stacks file */
    struct frame_bytes voxels; /* goblins: the .voxels file */
    size_t n_images;
    struct aov_image *image;
    struct ledger ledger;
    double volume_m3; /* sum of viability times h^3 */
    double start_volume_m3;
    size_t n_changes;
    struct frame_change change[PROCESSES];
    double max_stress_Pa; /* at the surface */
    int stress_iterations;
};

void frame_free(struct frame *frame);

#endif
