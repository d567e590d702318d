/* Disk space that a run's files will take, estimated before the run. The constants in disk.c were measured on our own files; estimates
 * are within a factor of about 1.5. */
#ifndef HOODOO_DISK_H
#define HOODOO_DISK_H

#include "job/job.h"
#include "scene/scene.h"

/* Bytes of a frame that has files of all kinds, by kind. */
struct disk_frame {
    uint64_t points, usd, volumes, pictures;
    uint64_t other; /* rocks, stacks, manifest */
};

/* What depends on the model. Bytes of a particle inside the rock and of one at its surface, in points/ and in volumes/, in exact
 * precision compressed with blosc; bytes of a channel of a picture's pixel that shows rock. */
struct disk_particle {
    double inside, bare, volumes_inside, volumes_bare, channel;
    unsigned
        has; /* HAS_* of the job, except HAS_ALWAYS: such values add grids to the volumes beyond those measured */
};

/* Bytes of a frame of a scene of `size`. The share of each picture that shows rock is found from size->point; if there are no points,
 * all of it does. */
struct disk_frame disk_frame(const struct job *job, const struct scene_size *size,
                             const struct disk_particle *particle);

/* The sum over all kinds of files. */
uint64_t disk_frame_bytes(const struct disk_frame *frame);

/* Bytes of these frames of the job, counting each kind of file in the frames that have it. *kinds gets the bytes by kind, unless it is
 * NULL. */
uint64_t disk_frames_bytes(const struct job *job, const struct disk_frame *frame, struct frame_range frames,
                           struct disk_frame *kinds);

#endif
