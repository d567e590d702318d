/* Renders AOV images: rays through each pixel into the surface field, and the values of the rock where they hit. */
#ifndef HOODOO_AOV_H
#define HOODOO_AOV_H

#include "field/camera.h"
#include "field/field.h"
#include "gpu/gpu.h"
#include "job/job.h"
#include "particles/frame.h"
#include "particles/particles.h"

/* Buffers for images of up to n_pixels, and the strata's colours. */
struct aov {
    size_t n_pixels;
    struct gpu_buffer *hit, *facing, *color, *means; /* vec4 [n_pixels] */
    struct gpu_buffer *ids;                          /* uint [n_pixels][3] */
    struct gpu_buffer *pixel;   /* 32 bits [n_pixels]: scratch, for one channel at a time */
    struct gpu_buffer *palette; /* vec4 [layers] */
    struct gpu_buffer *still;   /* vec4 [1]: a wind of 0 */
    bool ground;                /* set by the caller: show level ground around the rock in the colours */
};

/* The wind for images: velocities on a lattice. velocity NULL: there is no wind. */
struct aov_air {
    struct grid_lattice lattice;
    struct gpu_buffer *velocity; /* vec4 [lattice], m/s; borrowed */
    bool unknown; /* there is wind, but its velocity is not known: images have no layer of it */
};

/* The job's camera of that name, or NULL. */
const struct job_camera *camera_named(const struct job *job, const char *name);

/* Pixels of the largest image of the job's AOV cameras; 0: there are none. */
size_t aov_pixels(const struct job *job);
/* Pixels of a camera's image, overscan included. */
size_t aov_camera_pixels(const struct job_camera *camera);

/* Device memory, bytes. */
uint64_t aov_bytes(size_t n_pixels);

/* Host memory of one image's channels, bytes. */
uint64_t aov_picture_bytes(const struct job *job);
MUST_USE status aov_create(struct gpu *gpu, const struct job *job, size_t n_pixels, struct aov *out);
void aov_destroy(struct gpu *gpu, struct aov *a);

/* Renders the image of a camera in a frame, with this wind (NULL: none). Free *out with aov_image_free(). Waits for the device. E_MEMORY. */
MUST_USE status aov_render(struct gpu *gpu, struct aov *a, const struct job *job,
                           const struct job_camera *camera, int frame, const struct field *f,
                           const struct particles *p, const struct aov_air *air, struct aov_image *out);

/* Renders the images of all AOV cameras of the job to out->image, for frame out->number. */
MUST_USE status aov_render_all(struct gpu *gpu, struct aov *a, const struct job *job, const struct field *f,
                               const struct particles *p, const struct aov_air *air, struct frame *out);

#endif
