/* A finished frame in host memory: what the writer turns into files. Everything is in the simulator's axes (z
 * up, m). */
#ifndef HOODOO_FRAME_H
#define HOODOO_FRAME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "job/job.h"
#include "particles/grids.h"
#include "particles/rock.h"

/* One camera's picture: planes of width * height values, top row first. */
struct aov_channel {
    const char *part;   /* layer of a multi-part file: rgba, depth, N, P, stress, ... */
    const char *name;   /* full channel name: "R", "Z", "N.X", "stress.trace" */
    const float *value; /* or NULL */
    const uint32_t *id; /* where value is NULL */
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
    int margin[2];                                /* px: of it, on every side, in x and y */
    double world_to_camera[16], world_to_ndc[16]; /* as EXR stores them, row vectors, in the files' axes */
    size_t n_channels;
    struct aov_channel *channel;
    void *memory; /* holds every plane; owned by the frame */
    size_t n_notes;
    struct aov_note *note; /* owned by the frame */
};
void aov_image_free(struct aov_image *image);

/* Where every particle of the start went. start = rock + deposit + fallen + left, exactly. */
struct ledger {
    uint64_t start, rock, deposit, fallen, left;
};

/* What a process changed of the rock's volume since the frame before; all of them together are the change. */
struct frame_change {
    const char *process; /* a name that lasts */
    double m3;           /* negative: taken from it */
};

/* Rocks to be put where the frame has piles of them: P, id, and in `layer` which of the tile's shapes. */
struct frame_rocks {
    bool wanted;
    struct rock at;
    size_t n_shapes;
    float (*box)[2][3]; /* [n_shapes] m: the corners of each, from its P */
};

/* Rock of the frame that has no particles (particles/deep.h), where files show them all the same: pieces.h makes them. */
enum { DEEP_VALUES = 3 };
struct frame_deep {
    int voxels[3]; /* of the domain; 0: there never is any */
    double h;      /* m: their side */
    size_t n;
    uint32_t *bits;            /* [held_words()] of its voxels; NULL where n is 0 */
    float *value[DEEP_VALUES]; /* [n] in voxel order: stress, von Mises stress, erodibility */
    /* The STATE fields of the particles of some voxels. From any thread, as long as the model is there. */
    const void *source;
    status (*make)(const void *source, const uint32_t *bits, struct rock *out);
};

/* A file's bytes that a model made itself; NULL: none. */
struct frame_bytes {
    void *bytes;
    size_t size;
};

struct frame {
    int number;
    double years; /* since the first frame */
    struct rock rock;
    struct frame_deep deep; /* behind its particles */
    struct frame_grids grids;
    struct frame_grids air; /* the wind; no grid where it is the same everywhere, or nobody asks for it */
    struct frame_rocks rocks;
    struct frame_bytes stacks; /* arches: the terrain itself */
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
