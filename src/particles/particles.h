/* The rock on the device: each field of particles.def as a buffer, sorted by voxel, and the surface found in it.
 *
 * Particles are sorted by the voxel that contains them, then by id. Voxels without particles only take bits (held.h). Neighbour loops run
 * over voxels, whose rows are contiguous.
 */
#ifndef HOODOO_PARTICLES_H
#define HOODOO_PARTICLES_H

#include "gpu/gpu.h"
#include "gpu/primitives.h"
#include "particles/held.h"
#include "particles/rock.h"

struct particles {
    size_t n, n_max;
    size_t n_deep; /* voxels of rock without a particle (deep.h); 0 unless set by particles_set_deep() */
    int voxels[3];
    double h;       /* m: particle spacing and voxel size */
    unsigned walls; /* of the domain: WALL_* of shared/params.h; set by the caller, 0 at first */
    struct gpu_buffer *field
        [ROCK_FIELDS]; /* [n_max]; NULL: v while nothing can move, and optional fields that are not kept */
    struct held_voxels held;    /* voxels with particles; with `around` also those around them */
    bool around;                /* particles_hold_around() */
    struct gpu_buffer *start;   /* uint [held + 1]: index of each held voxel's first particle */
    struct gpu_buffer *fill;    /* float [held]: share of rock, as of the last particles_fill() */
    struct gpu_buffer *surface; /* uint [n_surface]: particles with an exposed face, ascending */
    size_t n_surface;
    /* Scratch, uint [max(n_max, held_words())], whose contents do not survive the next process. `taken` has at least a word for each held
     * voxel. */
    struct gpu_buffer *flags, *place, *taken;
    bool moving; /* particles may be anywhere in their voxels: particles_fill() spreads them over several */
};

/* The capacity to allocate for n particles: an eighth more, so that it does not grow for every few particles. */
static inline size_t particles_capacity_for(size_t n)
{
    return n + n / 8;
}

/* The number of items of `flags` and `place`. */
static inline size_t particles_scratch(const int voxels[3], size_t n_max)
{
    return n_max > held_words(voxels) ? n_max : held_words(voxels);
}

/* Device memory for n particles in a domain of so many voxels, bytes. */
uint64_t particles_bytes(size_t n, const int voxels[3]);

/* Uploads the rock's fields up to `keep` (STATE, or DERIVED for all; NULL fields become 0) and sorts them. The caller keeps ownership of
 * `rock`. Waits for the device. E_MEMORY. */
MUST_USE status particles_create(struct gpu *gpu, struct gpu_work *work, const struct rock *rock, int keep,
                                 const int voxels[3], double h, struct particles *out);
void particles_destroy(struct gpu *gpu, struct particles *p);

/* Removes particles of which nothing is left and restores the order. Invalidates DERIVED fields, except stress, which is sorted, too. Waits
 * for the device. */
MUST_USE status particles_index(struct gpu *gpu, struct gpu_work *work, struct particles *p);

/* The same, but keeps particles that are still moving, whose viability is negative and of which nothing is left. */
MUST_USE status particles_index_waiting(struct gpu *gpu, struct gpu_work *work, struct particles *p);

/* The same, but removes none. */
MUST_USE status particles_index_all(struct gpu *gpu, struct gpu_work *work, struct particles *p);

/* From now on the voxels around those with particles are held, too, for rubble and moving rock, which spread into empty voxels. Reindexes as
 * particles_index(). Waits for the device. */
MUST_USE status particles_hold_around(struct gpu *gpu, struct gpu_work *work, struct particles *p);

/* Allocates velocities, which are 0 at first. E_MEMORY. */
MUST_USE status particles_allow_motion(struct gpu *gpu, struct particles *p);

/* Allocates an optional field (rock_field_is_optional()), which is 0 at first. E_MEMORY. */
MUST_USE status particles_keep(struct gpu *gpu, struct particles *p, enum rock_field field);

/* Sums the particles' viability into the held voxels' fill, which is valid until the next reindexing. Records only. */
void particles_fill(struct gpu *gpu, struct particles *p);

/* Finds the surface particles and their normals (field N; 0 inside). Waits for the device. */
MUST_USE status particles_surface(struct gpu *gpu, struct gpu_work *work, struct particles *p);

/* Downloads all fields up to `keep` into *out, to be freed with rock_free(). Waits for the device. E_MEMORY. */
MUST_USE status particles_download(struct gpu *gpu, const struct particles *p, int keep, struct rock *out);

/* The parameters of a kernel over n items that accesses voxels. */
struct voxel_params particles_params(const struct particles *p, size_t n);

#endif
