/* A picture to look at: what the rays found (field/aov.h), in the view of previews (render/develop.h), before the job's sky and on
 * level ground. Grain of 0.2 to 20 m, fixed to the world, says how large things are where it is wider than two pixels. */
#ifndef HOODOO_LOOK_SHOT_H
#define HOODOO_LOOK_SHOT_H

#include "field/camera.h"
#include "particles/frame.h"
#include "render/show.h"

struct shot {
    struct camera camera;
    unsigned char *rgb; /* [height][width][3] sRGB; in `ppm` */
    float *depth;       /* [height][width] m from the camera's plane, of the rock; HUGE_VALF: there is none */
    void *ppm;          /* the picture as a file */
    size_t size;
};

/* `image`: with the layers rgba, depth, N, P, and that of `show`, in the simulator's axes. shot_free(). */
MUST_USE status shot_make(const struct job *job, int frame, const struct aov_image *image,
                          const struct camera *camera, enum value_id show, struct show_range range,
                          struct shot *out);
void shot_free(struct shot *s);

/* A line in the world, m, a pixel and a half wide; faint where rock or ground hides it. */
void shot_line(struct shot *s, const double from[3], const double to[3], const unsigned char rgb[3]);

#endif
