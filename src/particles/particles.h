/* The rock on the device: every field of particles.def as a buffer, ordered by voxel, and the surface found
 * in it.
 *
 * Particles are sorted by the voxel they lie in, those of one voxel by id. Voxels that have none take no memory but a bit
 * (held.h). Passes over neighbours walk voxels, rows of which are contiguous.
 */
#ifndef HOODOO_PARTICLES_H
#define HOODOO_PARTICLES_H

#include "gpu/gpu.h"
#include "gpu/primitives.h"
#include "particles/held.h"
#include "particles/rock.h"

struct particles {
    size_t n, n_max;
    size_t n_deep; /* voxels of rock that have no particle yet (deep.h); 0 unless somebody says otherwise */
    int voxels[3];
    double h;       /* m: spacing, and a voxel's size */
    unsigned walls; /* the domain's: WALL_* of shared/params.h. 0 until the caller sets it */
    struct gpu_buffer *field
        [ROCK_FIELDS]; /* n_max items each; NULL: v while nothing can move, and what only some rock has (rock_field_asked()) */
    struct held_voxels held;    /* voxels with particles; with `around`, those around them too */
    bool around;                /* particles_hold_around() */
    struct gpu_buffer *start;   /* uint [held + 1]: the first particle of each, and the end */
    struct gpu_buffer *fill;    /* float [held]: how much of each is rock, as of particles_fill() */
    struct gpu_buffer *surface; /* uint [n_surface]: the particles with a bare face, ascending */
    size_t n_surface;
    /* Scratch, uint [n_max], or held_words() where that is more: what a process leaves in it is lost to the next. `taken` may have more, a word for each held
     * voxel. */
    struct gpu_buffer *flags, *place, *taken;
    bool moving; /* particles are not in their voxels' middles: particles_fill() spreads them */
};

/* Particles there is room for, so that a few more do not ask for more room, where n are asked for. */
static inline size_t particles_room_for(size_t n)
{
    return n + n / 8;
}

/* Items of `flags` and `place`. */
static inline size_t particles_scratch(const int voxels[3], size_t n_max)
{
    return n_max > held_words(voxels) ? n_max : held_words(voxels);
}

/* Bytes on the device with room for n particles in a domain of so many voxels. */
uint64_t particles_bytes(size_t n, const int voxels[3]);

/* Uploads the rock's fields up to `keep` (STATE, or DERIVED for all; NULL ones are zero) and orders them. The
 * caller keeps `rock`. */
MUST_USE status particles_create(struct gpu *gpu, struct gpu_work *work, const struct rock *rock, int keep,
                                 const int voxels[3], double h, struct particles *out);
void particles_destroy(struct gpu *gpu, struct particles *p);

/* Drops particles of which nothing is left and restores the order. DERIVED fields are stale after it, but for stress, which
 * goes with the particles. Waits. */
MUST_USE status particles_index(struct gpu *gpu, struct gpu_work *work, struct particles *p);

/* The same, but does not drop those that wait to come to rest, of which nothing is left and whose viability is negative. */
MUST_USE status particles_index_waiting(struct gpu *gpu, struct gpu_work *work, struct particles *p);

/* The same, but drops none. */
MUST_USE status particles_index_all(struct gpu *gpu, struct gpu_work *work, struct particles *p);

/* From now on the voxels around those with particles are held too, as long as there may be rubble or rock in motion: it fills
 * voxels that have none. As particles_index(). Waits. */
MUST_USE status particles_hold_around(struct gpu *gpu, struct gpu_work *work, struct particles *p);

/* Makes room for velocities, 0 so far. */
MUST_USE status particles_allow_motion(struct gpu *gpu, struct particles *p);

/* From now on they have a field that only some rock has, 0 so far. */
MUST_USE status particles_keep(struct gpu *gpu, struct particles *p, enum rock_field field);

/* Takes the particles' viability into the held voxels' fill, which holds until they are indexed anew. Records only. */
void particles_fill(struct gpu *gpu, struct particles *p);

/* Finds the surface and its normals (field N; 0 inside). Waits. */
MUST_USE status particles_surface(struct gpu *gpu, struct gpu_work *work, struct particles *p);

/* All fields into a rock allocated here. */
MUST_USE status particles_download(struct gpu *gpu, const struct particles *p, int keep, struct rock *out);

/* The parameters of a kernel over n items that walks voxels. */
struct voxel_params particles_params(const struct particles *p, size_t n);

#endif
