/* The state of goblins at another spacing: the share that is left of each voxel, and its factor (src/resample has the rules). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "model/goblins.h"
#include "model/resampling.h"
#include "resample/split.h"
#include "scene/scene.h"
#include "voxels/voxels.h"

/* Arrays over all voxels. */
struct grid {
    struct spacing s;
    const float *share, *factor;       /* of the state */
    float *first_share, *first_factor; /* of the scene */
};

static size_t voxel_number(const struct spacing *s, const int v[3])
{
    return ((size_t)v[2] * (size_t)s->n[1] + (size_t)v[1]) * (size_t)s->n[0] + (size_t)v[0];
}

static status scene_of(const struct job *job, struct grid *g)
{
    status st = OK;
    const size_t n = (size_t)g->s.n[0] * (size_t)g->s.n[1] * (size_t)g->s.n[2];
    TRY(memory_alloc(n, sizeof(float), "voxels", &g->first_share));
    TRY(memory_alloc(n, sizeof(float), "voxels", &g->first_factor));
    TRY(scene_grid(job, job->goblins.floats, g->first_share, g->first_factor));
done:
    return st;
}

/* The factor of voxel `is` at the new spacing, of which voxel `was` was a part, or the other way round. */
static float factor_of(const struct grid *was, size_t w, const struct grid *is, size_t i)
{
    if (was->first_share[w] <= 0 || is->first_share[i] <= 0)
        return was->factor[w];
    return is->first_factor[i] * resample_painted(was->factor[w], was->first_factor[w]);
}

/* Weathering leaves a skin of partly used up voxels, not a surface that cuts them: all parts of a voxel are used up alike. */
static void divide(const struct resample *r, const struct grid *was, const int v[3], const struct grid *is,
                   float *share, float *factor)
{
    float most[SPLIT_VOXELS] = {0}, part[SPLIT_VOXELS];
    const size_t w = voxel_number(&was->s, v), each = (size_t)r->k * (size_t)r->k * (size_t)r->k;
    EACH_CHILD(r, v, most[e] = is->first_share[voxel_number(&is->s, child)];)
    split_evenly(each, (double)was->share[w], (double)was->first_share[w], most, part);
    EACH_CHILD(r, v, {
        const size_t i = voxel_number(&is->s, child);
        if ((double)part[e] >= RESAMPLE_SLIVER) {
            share[i] = part[e];
            factor[i] = factor_of(was, w, is, i);
        }
    })
}

static void make_finer(const struct resample *r, const struct grid *was, const struct grid *is, float *share,
                       float *factor)
{
    const int *n = was->s.n;
#pragma omp parallel for schedule(dynamic)
    for (int z = 0; z < n[2]; z++)
        for (int y = 0; y < n[1]; y++)
            for (int x = 0; x < n[0]; x++) {
                const int v[3] = {x, y, z};
                if (was->share[voxel_number(&was->s, v)] > 0)
                    divide(r, was, v, is, share, factor);
            }
}

static void make_coarser(const struct resample *r, const struct grid *was, const struct grid *is,
                         float *share, float *factor)
{
    const double part = 1 / pow(r->k, 3);
    const int *n = is->s.n;
#pragma omp parallel for schedule(dynamic)
    for (int z = 0; z < n[2]; z++)
        for (int y = 0; y < n[1]; y++)
            for (int x = 0; x < n[0]; x++) {
                const size_t i = voxel_number(&is->s, (const int[]){x, y, z});
                double sum = 0, weighted = 0;
                for (int e = 0; e < r->k * r->k * r->k; e++) {
                    const int v[3] = {x * r->k + e % r->k, y * r->k + e / r->k % r->k,
                                      z * r->k + e / (r->k * r->k)};
                    if (!spacing_holds(&was->s, v))
                        continue;
                    const size_t w = voxel_number(&was->s, v);
                    sum += (double)was->share[w];
                    weighted += (double)(was->share[w] * factor_of(was, w, is, i));
                }
                if (sum * part < RESAMPLE_SLIVER)
                    continue;
                share[i] = (float)(sum * part);
                factor[i] = (float)(weighted / sum);
            }
}

status goblins_resample(struct resampling *r)
{
    status st = OK;
    struct grid was = {.s = r->ratio.was}, is = {.s = r->ratio.is};
    const size_t n = (size_t)is.s.n[0] * (size_t)is.s.n[1] * (size_t)is.s.n[2];
    void *share, *factor;
    TRY(goblins_read(r->from, was.s.n, &r->ledger, &was.share, &was.factor));
    TRY(scene_of(&r->before, &was));
    TRY(scene_of(r->job, &is));
    TRY(section_add(r->out, "voxels", 4, n, &share));
    TRY(section_add(r->out, "factors", 4, n, &factor));
    (r->ratio.finer ? make_finer : make_coarser)(&r->ratio, &was, &is, share, factor);
    for (size_t i = 0; i < n; i++) {
        r->counts.rock += ((const float *)share)[i] > VOXELS_SLIVER;
        r->counts.start += ((const float *)share)[i] > VOXELS_SLIVER || is.first_share[i] > VOXELS_SLIVER;
    }
done:
    free(was.first_share);
    free(was.first_factor);
    free(is.first_share);
    free(is.first_factor);
    return st;
}
