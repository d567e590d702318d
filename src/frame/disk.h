/* What a run's files will take on disk, before it runs: from what was measured of ours (disk.c), within a factor of
 * about one and a half. */
#ifndef HOODOO_DISK_H
#define HOODOO_DISK_H

#include "job/job.h"
#include "scene/scene.h"

/* Bytes of a frame that has all kinds of files, by kind. */
struct disk_frame {
    uint64_t points, usd, volumes, pictures;
    uint64_t other; /* rocks, stacks, manifest */
};

/* What depends on the model. Bytes of one particle in points/ and in volumes/, of one inside and of one at the
 * surface, exact and with blosc; of a channel of a picture's pixel where rock is. */
struct disk_particle {
    double inside, bare, volumes_inside, volumes_bare, channel;
    unsigned
        has; /* HAS_*, but HAS_ALWAYS: what the job has, whose volumes then have more grids than those measured */
};

/* What a frame of `size` takes. size->point says how much of the pictures is rock; without any all of it is. */
struct disk_frame disk_frame(const struct job *job, const struct scene_size *size,
                             const struct disk_particle *particle);

/* All of a frame's files. */
uint64_t disk_frame_bytes(const struct disk_frame *frame);

/* The files of these frames of the job, each kind in the frames that have it; by kind in *kinds unless NULL. */
uint64_t disk_frames_bytes(const struct job *job, const struct disk_frame *frame, struct frame_range frames,
                           struct disk_frame *kinds);

#endif
