/* A look at a job: one picture of one frame, in seconds, without an output folder.
 *
 * Method             The job is coarsened (sketch.h). The state of the frame is taken from the cache, or simulated from the latest
 *                    cached state before it (states.h). Then one camera is rendered on the device; no other files are made.
 * Reuse              A struct look keeps the device and its kernels for further looks.
 * Calling sequence   look_begin(), any number of look_make(), look_end().
 */
#ifndef HOODOO_LOOK_LOOK_H
#define HOODOO_LOOK_LOOK_H

#include <stdbool.h>

#include "look/gizmos.h"
#include "look/sketch.h"
#include "render/show.h"
#include "text/text.h"

struct look;

/* Opens the device. `seconds`: what looks may take (struct sketch_options); if few, lavapipe is asked to work without threads of its own,
 * unless LP_NUM_THREADS is set: handing them a small kernel takes longer than the kernel. Errors as gpu_create(). */
MUST_USE status look_begin(const char *device, double seconds, struct look **out);
void look_end(struct look **look);

/* Is the device a GPU? */
bool look_on_gpu(const struct look *look);

struct look_options {
    struct sketch_options sketch;
    const char *folder; /* for temporary files, which the slate needs */
    bool no_slate, no_legend, figure;
    enum gizmos gizmos;
    const char *cut;   /* "x=12.5": cut the rock there, which also shows its inside; NULL: as a whole */
    const char *range; /* range of the shown value, "LO:HI"; NULL: that of the job */
    bool (*stop)(void *user);
    void (*frame)(void *user, int frame); /* called after each simulated frame; NULL: none */
    void (*begin)(void *user, struct frame_range frames);
    void *user;
};

/* The result of look_make(). */
struct look_made {
    void *png; /* the bytes of a PNG file */
    size_t png_size;
    char name[72];           /* name of the job */
    struct show_range range; /* range of the shown value */
    int frame, began;        /* `began`: the frame of the cached state, or the job's first frame */
    bool found;              /* a cached state was used */
    double years, spacing_m, own_spacing_m, air_m;
    size_t n_particles;                 /* estimate */
    struct model_estimate own_estimate; /* of the job as written */
    double own_seconds;                 /* see struct sketch */
    double load_seconds, step_seconds, picture_seconds;
    struct text gizmos; /* one line per object */
    struct text coarse; /* details lost at the coarse spacing, one per line */
};
void look_made_free(struct look_made *made);

/* Adds the report's curves over the frames of the last picture's job whose states have been simulated or found in the cache, with that
 * picture's frame marked, as members to a JSON object; none before the first picture. E_MEMORY. */
MUST_USE status look_curves(struct look *look, struct text *json);

/* Makes the picture. Release *out with look_made_free(). E_OUTPUT: the folder cannot be written. STOPPED: options->stop returned true; the
 * states reached so far are cached. Other errors as sketch_load(), model_create() and model_step(). */
MUST_USE status look_make(struct look *look, const struct look_options *options, struct look_made *out);

/* Adds members to a JSON object: "rock", whether there is rock at the point x, y (0..1 from the upper left corner) of the last picture, and if
 * so the position and all values there. The picture must have been made with `all_layers`. */
void look_at(const struct look *look, double x, double y, struct text *json);

#endif
