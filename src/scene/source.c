#include "scene/source.h"

#include <stdlib.h>

#include "base/hash.h"
#include "base/memory.h"
#include "geology/attitude.h"
#include "scene/sampler.h"

struct scene_source {
    struct sampler s;
    size_t row_words, words; /* of a row; of all rows */
    uint32_t *rock;          /* [words]: the voxels that contain rock */
    uint32_t *before;        /* [words + 1]: the number of such voxels in all words before */
};

static void voxel_at(const struct scene_source *src, size_t word, int bit, int voxel[3])
{
    const size_t row = word / src->row_words, ny = (size_t)src->s.n[1];
    voxel[0] = (int)(32 * (word % src->row_words)) + bit;
    voxel[1] = (int)(row % ny);
    voxel[2] = (int)(row / ny);
}

static int bits_in(uint32_t word)
{
    return __builtin_popcount(word);
}

/* Runs BODY for each set bit of a word, lowest first, with its number `bit`. */
#define EACH_BIT(word, BODY)                                                                                 \
    for (uint32_t left = (word); left != 0; left &= left - 1) {                                              \
        const int bit = __builtin_ctz(left);                                                                 \
        BODY                                                                                                 \
    }

static status find_voxels(struct scene_source *src)
{
    status st = OK;
    const int *n = src->s.n;
    src->row_words = ((size_t)n[0] + 31) / 32;
    src->words = src->row_words * (size_t)n[1] * (size_t)n[2];
    TRY(memory_alloc(src->words, sizeof *src->rock, "the scene's voxels", &src->rock));
    TRY(memory_alloc(src->words + 1, sizeof *src->before, "the scene's voxels", &src->before));
#pragma omp parallel for schedule(dynamic, 256)
    for (size_t w = 0; w < src->words; w++) {
        int v[3];
        voxel_at(src, w, 0, v);
        for (int bit = 0; bit < 32 && v[0] + bit < n[0]; bit++)
            src->rock[w] |= (uint32_t)(coverage_at(src->s.coverage, v[0] + bit, v[1], v[2]) > 0) << bit;
    }
    uint64_t sum = 0;
    for (size_t w = 0; w < src->words; w++) {
        sum += (uint64_t)bits_in(src->rock[w]);
        if (sum > UINT32_MAX)
            return fail(E_MEMORY, "scene: it has more than 2^32 particles: raise domain.spacing_m");
        src->before[w + 1] = (uint32_t)sum;
    }
done:
    return st;
}

/* Adds every particle as an occluder, if the paint needs them. */
static void add_occluders(struct scene_source *src)
{
    if (!paint_needs_occluders(src->s.paint))
        return;
    for (size_t w = 0; w < src->words; w++)
        EACH_BIT(src->rock[w], {
            int v[3];
            float P[4];
            voxel_at(src, w, bit, v);
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
    free((*source)->rock);
    free((*source)->before);
    free(*source);
    *source = NULL;
}

size_t scene_source_count(const struct scene_source *src)
{
    return src->before[src->words];
}

static uint32_t id_of(const struct scene_source *src, size_t word, int bit)
{
    return src->before[word] + (uint32_t)bits_in(src->rock[word] & ((1U << bit) - 1));
}

/* ---- particles */

static void make_particle(const struct scene_source *src, size_t word, int bit, struct rock *rock, size_t p)
{
    const struct sampler *s = &src->s;
    int v[3];
    double x[3];
    voxel_at(src, word, bit, v);
    sampler_position(s, v, rock->P + 4 * p);
    rock_position(rock, p, x);
    struct paint_values paint = paint_at(s->paint, x, 0);
    rock->id[p] = id_of(src, word, bit);
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
    return src->rock[word] & (bits ? bits[word] : ~0U) & ~(but ? but[word] : 0U);
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
    const size_t slab = src->words / (size_t)src->s.n[2];
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
    voxel_at(src, word, bit, v);
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
    for (size_t w = 0; w < src->words; w++) {
        uint32_t uniform = 0;
        EACH_BIT(src->rock[w], { uniform |= (uint32_t)is_uniform(src, w, bit) << bit; })
        bits[w] = uniform;
        sum += (size_t)bits_in(uniform);
    }
    *n = sum;
}

bool scene_source_ids(const struct scene_source *src, const uint32_t *bits, uint32_t *ids)
{
    bool full = true;
    for (size_t w = 0; w < src->words; w++) {
        full &= (bits[w] & ~src->rock[w]) == 0;
        EACH_BIT(bits[w] & src->rock[w], {
            int v[3];
            voxel_at(src, w, bit, v);
            full &= is_full(src, v);
            *ids++ = id_of(src, w, bit);
        })
    }
    return full;
}

uint64_t scene_source_hash(const struct scene_source *src)
{
    return hash_bytes(src->rock, src->words * sizeof *src->rock);
}

status scene_source_sample(const struct scene_source *src, struct rock *rock)
{
    enum { ABOUT = 1000 };
    status st = OK;
    uint32_t *bits = NULL;
    const uint32_t every = (uint32_t)(scene_source_count(src) / ABOUT + 1);
    TRY(memory_alloc(src->words, sizeof *bits, "some of the scene's voxels", &bits));
    for (size_t w = 0; w < src->words; w++)
        if (src->before[w] / every != src->before[w + 1] / every)
            bits[w] = src->rock[w] & (~src->rock[w] + 1);
    TRY(scene_source_particles(src, bits, NULL, rock));
done:
    free(bits);
    return st;
}
