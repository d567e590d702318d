/* Rock at another spacing: the particles of a state whose spacing is a whole multiple or a whole fraction of the new one.
 *
 * Rock that stands   smaller voxels are cut by a smooth surface through the old ones (split.h); a larger one has the mean of its voxels.
 *                    Its particle is that of the job's scene there, with its layer, noise and structure; what edits have painted since
 *                    is the ratio of the old particle's factors to those of the scene at the old spacing. Faces that are still as the
 *                    scene has them get the scene's own shape. Rock that edits have added keeps the old particle's values.
 * Deposits           keep their values; a smaller spacing makes k^3 particles of each, a larger one a particle of each voxel's deposits.
 * Deep rock          stays deep at a smaller spacing, and gets its particles at a larger one.
 *
 * There is as much rock as before, but for faces that are as the scene has them. README.md has the equations. */
#ifndef HOODOO_RESAMPLE_H
#define HOODOO_RESAMPLE_H

#include <stdbool.h>

#include "particles/rock.h"
#include "particles/voxel_set.h"
#include "scene/coverage.h"
#include "scene/source.h"

enum { RESAMPLE_MOST = 8 }; /* the largest ratio of the spacings */

/* A domain of n voxels of h metres. */
struct spacing {
    int n[3];
    double h;
};

struct resample {
    struct spacing was, is;
    int k;      /* their ratio, 2 to RESAMPLE_MOST */
    bool finer; /* the new spacing is the smaller one */
};

/* Sets k and finer. The domains must be the same, but for the last pair of voxels. False: the ratio is not a whole number up to
 * RESAMPLE_MOST, or the domains differ. */
bool resample_fits(struct resample *r);

static inline bool spacing_holds(const struct spacing *s, const int v[3])
{
    return v[0] < s->n[0] && v[1] < s->n[1] && v[2] < s->n[2];
}

/* Runs a block for each new voxel in the old voxel `parent`, x fastest: its voxel is `child`, its number `e`. */
#define EACH_CHILD(r, parent, ...)                                                                           \
    for (int e = 0; e < (r)->k * (r)->k * (r)->k; e++) {                                                     \
        const int child[3] = {(parent)[0] * (r)->k + e % (r)->k, (parent)[1] * (r)->k + e / (r)->k % (r)->k, \
                              (parent)[2] * (r)->k + e / ((r)->k * (r)->k)};                                 \
        if (spacing_holds(&(r)->is, child)) {                                                                \
            __VA_ARGS__                                                                                      \
        }                                                                                                    \
    }

/* Voxels of which less than this is rock have no particle, as in scenes. */
static const double RESAMPLE_SLIVER = 1.0 / COVERAGE_FULL;

/* A factor that has been painted on a value since the start; 1 where rounding alone makes it differ. */
float resample_painted(float now, float first);

/* The rock of a state. The STATE fields have phases 0 and 1 only. */
struct resample_from {
    const struct rock *rock;
    const uint32_t *deep;             /* the bits of its voxels without particles; NULL: none */
    const struct scene_source *scene; /* the job's scene at its spacing */
};

/* The new rock. */
struct resample_to {
    const struct scene_source *scene; /* input: the job's scene at the new spacing */
    struct rock
        rock; /* STATE fields; in voxel order of the old spacing, deposits last. The caller frees it */
    struct voxel_set deep; /* voxels without particles, with ranks; the caller frees it */
    uint64_t n_ids;        /* all ids are below this number */
};

/* E_MEMORY: also if there are more than 2^32 particles. */
MUST_USE status resample_rock(const struct resample *r, const struct resample_from *from,
                              struct resample_to *to);

#endif
