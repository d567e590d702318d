/* A job for a quick look: coarse enough for the available time, and with a single picture.
 *
 * Spacing    Rates are in metres and years, so that a coarse run shows the same rock, less sharp. The spacing is the job's own times the
 *            smallest of a few factors with which the frames take about `seconds`, as long as at least LOOK_LEAST particles remain. The
 *            time per particle and step was measured with lavapipe on two cores, per model; GPUs are assumed to be LOOK_GPU times as fast. This
 *            estimate affects nothing but the time.
 * Branches   A job that begins with a checkpoint keeps its own spacing, unless `spacing_m` is given.
 * Air        The spacing of flowing air is raised to a sixth of the longest side of the domain, since the flow would take most of the time.
 * Pictures   One of the job's cameras (the first, or a named one), or a camera that sees the domain from a direction. The picture has the
 *            shape of the camera and is at most `width` pixels wide.
 */
#ifndef HOODOO_LOOK_SKETCH_H
#define HOODOO_LOOK_SKETCH_H

#include <stdbool.h>
#include <stddef.h>

#include "job/job.h"
#include "job/values.h"
#include "model/model.h"

enum { LOOK_LEAST = 1500, LOOK_GPU = 30 };

struct sketch_options {
    const char *path;        /* the job file */
    const char *const *sets; /* [n_sets] arguments of --set */
    size_t n_sets;
    int wedge;         /* 0: the job itself */
    const char *from;  /* OUT@FRAME: begin with that checkpoint; NULL: as the job says */
    const char *frame; /* NULL: the last */
    const char *
        camera; /* a name, or "AZIMUTH,ELEVATION" in degrees; NULL: the job's first, or one that sees the domain */
    int width;          /* px: upper limit */
    int samples;        /* rays per pixel */
    double seconds;     /* HUGE_VAL: the job's own spacing */
    double spacing_m;   /* > 0: this spacing, whatever time it takes */
    double zoom;        /* magnification for a camera by direction; 0: 1 */
    enum value_id show; /* VALUE_NONE: the rock as it looks */
    bool all_layers;    /* render all layers, for look_at() */
    bool gpu;           /* the device will be a GPU */
};

struct sketch {
    struct job *job;                 /* the coarse job, to be simulated */
    struct job *own;                 /* the job as written */
    const struct job_camera *camera; /* a camera of `job` */
    int frame;
    /* Of the job as written: */
    double own_spacing_m;
    struct model_estimate own_estimate;
    double
        own_seconds; /* about what all its frames take to simulate on this device; within a factor of three */
};

/* The job as written, or its wedge, ready to begin with a checkpoint. Release *out with job_destroy(). Errors as job_load() and
 * branch_from(). */
MUST_USE status sketch_read_job(const struct sketch_options *options, struct job **out);

/* Release *out with sketch_free(). E_USAGE: no such camera or frame. Other errors as
 * job_load() and branch_from(). */
MUST_USE status sketch_load(const struct sketch_options *options, struct sketch *out);
void sketch_free(struct sketch *s);

/* Adds the warnings (run/advice.h) that apply to the coarse job but not to the job as written, one per line: mainly features too thin for the
 * spacing. */
MUST_USE status sketch_loses(const struct sketch *s, struct text *out);

#endif
