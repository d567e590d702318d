/* A look at a job: one picture of one frame, in seconds, without an output folder.
 *
 * What it does   The job is made coarse (sketch.h), its state of the frame is found or simulated on from the nearest that is kept
 *                (states.h), and one camera's rays are shaded on the device; nothing else of a frame is made.
 * Again          A second look with the same struct look has the device and its kernels ready.
 * Calling sequence   look_begin(), any number of look_make(), look_end().
 */
#ifndef HOODOO_LOOK_LOOK_H
#define HOODOO_LOOK_LOOK_H

#include <stdbool.h>

#include "base/text.h"
#include "look/gizmos.h"
#include "look/sketch.h"
#include "render/show.h"

struct look;

/* E_DEVICE as gpu_create(). */
MUST_USE status look_begin(const char *device, struct look **out);
void look_end(struct look **look);

/* Is it on a GPU? */
bool look_on_gpu(const struct look *look);

struct look_options {
    struct sketch_options sketch;
    const char *folder; /* for files of a moment where there is a slate */
    bool no_slate, figure;
    enum gizmos gizmos;
    const char *range; /* of what is shown: "LO:HI", or NULL: the job's */
    bool (*stop)(void *user);
    void (*frame)(void *user, int frame); /* it is simulated; NULL: nobody asks */
    void (*begin)(void *user, struct frame_range frames);
    void *user;
};

/* What came of it. */
struct look_made {
    void *png; /* the picture as a file's bytes */
    size_t png_size;
    char name[72];           /* of the job */
    struct show_range range; /* of what is shown */
    int frame, began;        /* `began`: the frame whose state was there; the job's first if none was */
    bool found;              /* a state was there */
    double years, spacing_m, own_spacing_m, air_m;
    size_t n_particles, own_particles; /* about */
    double load_seconds, step_seconds, picture_seconds;
    struct text gizmos; /* a line each */
    struct text coarse; /* what is lost at the coarse spacing, a line each */
};
void look_made_free(struct look_made *made);

/* E_OUTPUT: the folder cannot be written. STOPPED: options->stop said so; states on the way are kept. As sketch_load(),
 * model_create() and model_step() besides. look_made_free(). */
MUST_USE status look_make(struct look *look, const struct look_options *options, struct look_made *out);

/* What is at a place of the last picture (0..1 from its upper left corner), as members of a JSON object: place and every value there,
 * and "rock" says whether there is any. Only of pictures with `all_layers`. */
void look_at(const struct look *look, double x, double y, struct text *json);

#endif
