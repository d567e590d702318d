/* Pictures of the fields: one ray a pixel into the surface field, and what lies where it lands. */
#ifndef HOODOO_AOV_H
#define HOODOO_AOV_H

#include "field/camera.h"
#include "field/field.h"
#include "gpu/gpu.h"
#include "job/job.h"
#include "particles/frame.h"
#include "particles/particles.h"

/* Buffers for pictures of up to n_pixels, and the strata's colours. */
struct aov {
    size_t n_pixels;
    struct gpu_buffer *hit, *facing, *color, *means; /* vec4 [n_pixels] */
    struct gpu_buffer *ids;                          /* uint [n_pixels][3] */
    struct gpu_buffer *pixel;                        /* a word [n_pixels]: of one value after the other */
    struct gpu_buffer *palette;                      /* vec4 [layers] */
    struct gpu_buffer *still;                        /* vec4 [1]: no wind */
    bool ground; /* set by whoever wants the level ground around the rock to be seen in the colours */
};

/* The wind as pictures see it: velocities on a lattice. Without `velocity` there is none. */
struct aov_air {
    struct grid_lattice lattice;
    struct gpu_buffer *velocity; /* vec4 [lattice], m/s; borrowed */
    bool unknown;                /* there is one, but not what it is: pictures have no layer of it */
};

/* The job's camera of that name, or NULL. */
const struct job_camera *camera_named(const struct job *job, const char *name);

/* The largest picture among the job's AOV cameras; 0 if it asks for none. */
size_t aov_pixels(const struct job *job);
size_t aov_camera_pixels(const struct job_camera *camera);
uint64_t aov_bytes(size_t n_pixels);
/* Bytes of one picture's channels in host memory. */
uint64_t aov_picture_bytes(const struct job *job);
MUST_USE status aov_create(struct gpu *gpu, const struct job *job, size_t n_pixels, struct aov *out);
void aov_destroy(struct gpu *gpu, struct aov *a);

/* The picture of one camera in a frame, in this air (NULL: none); out->memory and out->channel are freed with aov_image_free(). Waits. */
MUST_USE status aov_render(struct gpu *gpu, struct aov *a, const struct job *job,
                           const struct job_camera *camera, int frame, const struct field *f,
                           const struct particles *p, const struct aov_air *air, struct aov_image *out);
/* The pictures of all the job's AOV cameras, into out->image; out->number is the
 * frame. */
MUST_USE status aov_render_all(struct gpu *gpu, struct aov *a, const struct job *job, const struct field *f,
                               const struct particles *p, const struct aov_air *air, struct frame *out);

#endif
