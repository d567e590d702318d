/* A job as it is looked at: coarse enough for the time there is, and with one picture.
 *
 * Spacing   Rates are in metres and years, so that a coarse run is the same rock, less sharp. The spacing is the job's own times the
 *           smallest of a few whole or half numbers with which the frames take about `seconds`, as far as at least LOOK_LEAST
 *           particles are left. What a particle takes in a step was measured on lavapipe on two cores; GPUs are taken
 *           to be as much faster as LOOK_GPU says. It is a guess, of which nothing but the time depends.
 * Air       A wind that flows has its air coarsened to a sixth of the domain's longest side: it takes most of the time else.
 * Pictures  One of the job's cameras (the first, or the one named), or one around the domain from a direction. Of its resolution at
 *           most `width` pixels are made, in its shape.
 */
#ifndef HOODOO_LOOK_SKETCH_H
#define HOODOO_LOOK_SKETCH_H

#include <stdbool.h>
#include <stddef.h>

#include "job/job.h"
#include "job/values.h"

enum { LOOK_LEAST = 1500, LOOK_GPU = 30 };

struct sketch_options {
    const char *path; /* of the job */
    const char *const *sets;
    size_t n_sets;
    int wedge;         /* 0: the job itself */
    const char *frame; /* NULL: the last */
    const char
        *camera;    /* NULL: its first, or one around the domain; a name; or "AZIMUTH,ELEVATION" in degrees */
    int width;      /* px: of the picture at most */
    int samples;    /* rays a pixel */
    double seconds; /* HUGE_VAL: the job's own spacing */
    double spacing_m;   /* > 0: this one, whatever it takes */
    double zoom;        /* of a direction: so many times as large; 0: 1 */
    enum value_id show; /* VALUE_NONE: the rock as it looks */
    bool all_layers;    /* of the picture, for look_at() */
    bool gpu;           /* it will be worked on one */
};

struct sketch {
    struct job *job;                 /* to be simulated */
    struct job *own;                 /* as it is written */
    const struct job_camera *camera; /* of it */
    int frame;
    double own_spacing_m; /* the job's as it is written */
    size_t own_particles; /* of the job as it is written, about */
};

/* E_USAGE: there is no such camera or frame; the job begins with another run's checkpoint. As job_load() besides. sketch_free(). */
MUST_USE status sketch_load(const struct sketch_options *options, struct sketch *out);
void sketch_free(struct sketch *s);

/* What advice (run/advice.h) has to say of the coarse job and not of the job as it is written, a line each: what is too thin for the
 * spacing, mostly. */
MUST_USE status sketch_loses(const struct sketch *s, struct text *out);

#endif
