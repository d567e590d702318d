/* A picture made from the layers of an AOV image (field/aov.h): tone-mapped like previews (render/develop.h), with the job's sky and level
 * ground. Grain with sizes of 0.2 to 20 m, fixed in the world, shows the scale where it is wider than two pixels. */
#ifndef HOODOO_LOOK_SHOT_H
#define HOODOO_LOOK_SHOT_H

#include "field/camera.h"
#include "particles/frame.h"
#include "render/show.h"

struct shot {
    struct camera camera;
    unsigned char *rgb; /* [height][width][3] sRGB; points into `ppm` */
    float *depth;       /* [height][width] m from the camera's plane to the rock; HUGE_VALF: no rock */
    void *ppm;          /* the picture as a file */
    size_t size;
};

/* `image` must have the layers rgba, depth, N, P and that of `show`, in the axes of the simulator. Release with shot_free(). */
MUST_USE status shot_make(const struct job *job, int frame, const struct aov_image *image,
                          const struct camera *camera, enum value_id show, struct show_range range,
                          struct shot *out);
void shot_free(struct shot *s);

/* Draws a line between two points in the world (m), 1.5 px wide; faint where it is behind rock or ground. */
void shot_line(struct shot *s, const double from[3], const double to[3], const unsigned char rgb[3]);

#endif
