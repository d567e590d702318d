#include "scene/source.h"

#include <stdlib.h>

#include "base/hash.h"
#include "base/memory.h"
#include "geology/attitude.h"
#include "particles/voxel_set.h"
#include "scene/sampler.h"

struct scene_source {
    struct sampler s;
    struct voxel_set rock; /* the voxels that contain rock */
};

static status find_voxels(struct scene_source *src)
{
    status st = OK;
    const int *n = src->s.n;
    struct voxel_set *rock = &src->rock;
    TRY(voxel_set_create(n, "the scene's voxels", rock));
#pragma omp parallel for schedule(dynamic, 256)
    for (size_t w = 0; w < rock->words; w++) {
        int v[3];
        voxel_set_at(rock, w, 0, v);
        for (int bit = 0; bit < 32 && v[0] + bit < n[0]; bit++)
            rock->bits[w] |= (uint32_t)(coverage_at(src->s.coverage, v[0] + bit, v[1], v[2]) > 0) << bit;
    }
    TRY(voxel_set_rank(rock));
done:
    return st;
}

/* Adds every particle as an occluder, if the paint needs them. */
static void add_occluders(struct scene_source *src)
{
    if (!paint_needs_occluders(src->s.paint))
        return;
    for (size_t w = 0; w < src->rock.words; w++)
        EACH_BIT(src->rock.bits[w], {
            int v[3];
            float P[4];
            voxel_set_at(&src->rock, w, bit, v);
            sampler_position(&src->s, v, P);
            paint_add_occluder(src->s.paint, (const double[]){(double)P[0], (double)P[1], (double)P[2]});
        })
}

status scene_source_create(const struct job *job, struct scene_source **out)
{
    status st = OK;
    struct scene_source *src = NULL;
    TRY(memory_alloc(1, sizeof *src, "the scene", &src));
    TRY(sampler_init(&src->s, job, NULL, COVERAGE_REACH));
    TRY(sampler_prepare(&src->s, job->paint, job->n_paint));
    TRY(sampler_check(&src->s, false));
    TRY(scene_log_inputs(job, sampler_scene(&src->s)));
    TRY(find_voxels(src));
    add_occluders(src);
    *out = src;
    src = NULL;
done:
    scene_source_destroy(&src);
    return st;
}

void scene_source_destroy(struct scene_source **source)
{
    if (!*source)
        return;
    sampler_deinit(&(*source)->s);
    voxel_set_destroy(&(*source)->rock);
    free(*source);
    *source = NULL;
}

size_t scene_source_count(const struct scene_source *src)
{
    return voxel_set_count(&src->rock);
}

/* ---- particles */

static void make_particle(const struct scene_source *src, size_t word, int bit, struct rock *rock, size_t p)
{
    const struct sampler *s = &src->s;
    int v[3];
    double x[3];
    voxel_set_at(&src->rock, word, bit, v);
    sampler_position(s, v, rock->P + 4 * p);
    rock_position(rock, p, x);
    struct paint_values paint = paint_at(s->paint, x, 0);
    rock->id[p] = voxel_set_before(&src->rock, word, bit);
    rock->viability[p] = (float)coverage_at(s->coverage, v[0], v[1], v[2]) / COVERAGE_FULL;
    rock->phase[p] = solid_at(s->solid, x).loose ? 1 : 0;
    const struct structure_rock built = sampler_structure(s, v);
    rock->layer[p] = (uint32_t)attitude_layer(s->job, x);
    rock->rate_factor[p] = (float)(sampler_rate_factor(s, rock->layer[p], x, &paint) * built.rate);
    rock->interlock_factor[p] = (float)(paint.interlock * built.interlock);
    rock->vegetation[p] = (float)paint.vegetation;
}

static uint32_t selected(const struct scene_source *src, const uint32_t *bits, const uint32_t *but,
                         size_t word)
{
    return src->rock.bits[word] & (bits ? bits[word] : ~0U) & ~(but ? but[word] : 0U);
}

static status check_memory(size_t n)
{
    size_t bytes = 0;
    for (int f = 0; f < ROCK_FIELDS; f++)
        if (rock_field_table[f].keep == STATE && !rock_field_is_optional(f))
            bytes += rock_field_size((enum rock_field)f);
    if (n > memory_available() / bytes)
        return fail(E_MEMORY,
                    "scene: %zu particles need %.3g GB, but only %.3g GB are free: raise domain.spacing_m", n,
                    1e-9 * (double)(n * bytes), 1e-9 * (double)memory_available());
    return OK;
}

status scene_source_particles(const struct scene_source *src, const uint32_t *bits, const uint32_t *but,
                              struct rock *rock)
{
    status st = OK;
    size_t *first = NULL;
    const size_t slab = src->rock.words / (size_t)src->s.n[2];
    const int nz = src->s.n[2];
    *rock = (struct rock){0};
    TRY(memory_alloc((size_t)nz + 1, sizeof *first, "the scene's slabs", &first));
    for (int k = 0; k < nz; k++) {
        first[k + 1] = first[k];
        for (size_t w = (size_t)k * slab; w < (size_t)(k + 1) * slab; w++)
            first[k + 1] += (size_t)bits_in(selected(src, bits, but, w));
    }
    TRY(check_memory(first[nz]));
    TRY(rock_alloc(rock, first[nz], STATE));
#pragma omp parallel for schedule(dynamic)
    for (int k = 0; k < nz; k++) {
        size_t p = first[k];
        for (size_t w = (size_t)k * slab; w < (size_t)(k + 1) * slab; w++)
            EACH_BIT(selected(src, bits, but, w), { make_particle(src, w, bit, rock, p++); })
    }
done:
    free(first);
    return st;
}

status scene_sample(const struct job *job, struct rock *rock)
{
    status st = OK;
    struct scene_source *src = NULL;
    *rock = (struct rock){0};
    TRY(scene_source_create(job, &src));
    TRY(scene_source_particles(src, NULL, NULL, rock));
done:
    scene_source_destroy(&src);
    return st;
}

/* ---- uniform voxels */

static bool is_full(const struct scene_source *src, const int v[3])
{
    return coverage_at(src->s.coverage, v[0], v[1], v[2]) == COVERAGE_FULL;
}

static bool is_uniform(const struct scene_source *src, size_t word, int bit)
{
    const struct sampler *s = &src->s;
    int v[3];
    float P[4];
    voxel_set_at(&src->rock, word, bit, v);
    if (!is_full(src, v))
        return false;
    sampler_position(s, v, P);
    const double x[3] = {(double)P[0], (double)P[1], (double)P[2]};
    return paint_at(s->paint, x, 0).vegetation <= 0 && !solid_at(s->solid, x).loose;
}

void scene_source_uniform(const struct scene_source *src, uint32_t *bits, size_t *n)
{
    size_t sum = 0;
#pragma omp parallel for schedule(dynamic, 64) reduction(+ : sum)
    for (size_t w = 0; w < src->rock.words; w++) {
        uint32_t uniform = 0;
        EACH_BIT(src->rock.bits[w], { uniform |= (uint32_t)is_uniform(src, w, bit) << bit; })
        bits[w] = uniform;
        sum += (size_t)bits_in(uniform);
    }
    *n = sum;
}

bool scene_source_ids(const struct scene_source *src, const uint32_t *bits, uint32_t *ids)
{
    bool full = true;
    for (size_t w = 0; w < src->rock.words; w++) {
        full &= (bits[w] & ~src->rock.bits[w]) == 0;
        EACH_BIT(bits[w] & src->rock.bits[w], {
            int v[3];
            voxel_set_at(&src->rock, w, bit, v);
            full &= is_full(src, v);
            *ids++ = voxel_set_before(&src->rock, w, bit);
        })
    }
    return full;
}

bool scene_source_has(const struct scene_source *src, const int voxel[3])
{
    return voxel_set_has(&src->rock, voxel);
}

void scene_source_position(const struct scene_source *src, const int voxel[3], float P[4])
{
    sampler_position(&src->s, voxel, P);
}

uint64_t scene_source_hash(const struct scene_source *src)
{
    return hash_bytes(src->rock.bits, src->rock.words * sizeof *src->rock.bits);
}

status scene_source_sample(const struct scene_source *src, struct rock *rock)
{
    enum { ABOUT = 1000 };
    status st = OK;
    uint32_t *bits = NULL;
    const uint32_t every = (uint32_t)(scene_source_count(src) / ABOUT + 1);
    TRY(memory_alloc(src->rock.words, sizeof *bits, "some of the scene's voxels", &bits));
    for (size_t w = 0; w < src->rock.words; w++)
        if (src->rock.before[w] / every != src->rock.before[w + 1] / every)
            bits[w] = src->rock.bits[w] & (~src->rock.bits[w] + 1);
    TRY(scene_source_particles(src, bits, NULL, rock));
done:
    free(bits);
    return st;
}
